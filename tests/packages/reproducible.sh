#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
#
# Usage: tests/packages/reproducible.sh FOLDER
# Builds the packages that scripts/release has made in FOLDER a second time, from a clone of the same commit in another
# folder, without ccache: the bytes must be the same. Lists the files that differ and, if diffoscope is installed, the
# differences.
set -euo pipefail
source=$(realpath "$(dirname "$0")/../..")
packages=$(realpath -m "${1:?folder of packages}")
[ -e "$packages/SHA256SUMS" ] || { echo "SKIPPED, NOT TESTED: no packages in $packages" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git clone --quiet "$source" "$work/another"
cd "$work/another"
export CCACHE_DISABLE=1
scripts/release "$work/again" >/dev/null
cd "$work/again"
sha256sum --check --quiet "$packages/SHA256SUMS" && exit 0
for file in *; do
  cmp -s "$file" "$packages/$file" || ! command -v diffoscope >/dev/null ||
    diffoscope --max-report-size 20000 "$packages/$file" "$file" || true
done
exit 1
