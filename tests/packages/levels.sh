#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
#
# Usage: tests/packages/levels.sh FOLDER
# Tests the archive that scripts/release has made in FOLDER. The dynamic linker must take the library for the given instruction
# set, and the libraries for x86-64-v2, v3 and v4 (as far as this processor supports them) must render the same, by Welch's
# test of `lanthorn compare`. This test only fails if three sets of seeds do, which lowers false alarms from 1 % to 1e-6.
set -euo pipefail
packages=$(realpath -m "${1:?folder of packages}")
archive=$(echo "$packages"/lanthorn-*-linux-x86_64.tar.zst)
[ -e "$archive" ] || { echo "SKIPPED, NOT TESTED: no archive in $packages" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
tar --zstd --extract --strip-components=1 --file "$archive"
linker=/lib64/ld-linux-x86-64.so.2
scenes=share/lanthorn/scenes

# The library of the lowest level is used if no other one may be.
lanthorn_for() { "$linker" --glibc-hwcaps-mask "$1" bin/lanthorn "${@:2}"; }
mapfile -t levels < <("$linker" --help | sed -n 's/^  \(x86-64-v[0-9]\) (supported, searched).*/\1/p')
for level in "${levels[@]}"; do
  lanthorn_for "$level" info --machine | grep -q "^compiled *for $level$" || { echo "not the library for $level" >&2; exit 1; }
done
[ "$(bin/lanthorn info --machine | sed -n 's/^compiled *for //p')" = "${levels[0]}" ] || { echo "not the newest library" >&2; exit 1; }
echo "The dynamic linker takes ${levels[0]} of ${levels[*]}."

runs=4
# renders LEVEL SCENE METHOD SET: renders LEVEL-1.exr ... with seeds that no other level or set uses.
renders() {
  for run in $(seq $runs); do
    seed=$((1000 * $4 + 100 * ${1#x86-64-v} + run))
    lanthorn_for "$1" render "$scenes/$2" -i "$3" -r 64x48 -p 16 --seed $seed -q -o "$1-$run.exr"
  done
}
agree() { # LEVEL LEVEL SCENE METHOD
  for set in 1 2 3; do
    renders "$1" "$3" "$4" $set
    renders "$2" "$3" "$4" $set
    bin/lanthorn compare "$1-1.exr" "$2-1.exr" --runs "$1"-[2-9].exr --reference-runs "$2"-[2-9].exr --require-agreement && return
  done
  return 1
}
for scene in cornell-caustics.pbrt prism.pbrt; do
  for method in path probppm vcm photonmap; do
    for level in "${levels[@]:1}"; do
      echo "$scene, $method: ${levels[0]} and $level"
      agree "${levels[0]}" "$level" $scene $method || { echo "they differ" >&2; exit 1; }
    done
  done
done
echo "Took $SECONDS s"
