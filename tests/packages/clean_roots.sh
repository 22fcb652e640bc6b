#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
#
# Usage: tests/packages/clean_roots.sh FOLDER [ROOT...]
# Installs the packages that scripts/release has made in FOLDER as users would, each in a minimal Debian, and uses them:
#   debian     the Debian packages, in Debian 12
#   bookworm, trixie, ...   the archive, in that version of Debian (default: debian bookworm trixie)
# Prints the seconds of each step. build/roots keeps the file systems that debootstrap makes, from its default mirror. Exits
# with 77, which ctest shows as skipped, if not run by root or if debootstrap is missing.
set -euo pipefail
case "${1:-}" in -h | --help) sed -n '/^# Usage/,/^[^#]/s/^# //p' "$0"; exit 0 ;; esac
[ "$(id -u)" = 0 ] || { echo "SKIPPED, NOT TESTED: only root can change roots" >&2; exit 77; }
command -v debootstrap >/dev/null || { echo "SKIPPED, NOT TESTED: no debootstrap (scripts/install-packages package)" >&2; exit 77; }
# Mounts of this namespace vanish when this process ends.
[ "${in_namespace:-}" ] || exec env in_namespace=1 unshare --mount --pid --fork --kill-child "$0" "$@"

source=$(realpath "$(dirname "$0")/../..")
packages=$(realpath -m "${1:?folder of packages}")
shift
archive=$(echo "$packages"/lanthorn-*-linux-x86_64.tar.zst)
[ -e "$archive" ] || { echo "SKIPPED, NOT TESTED: no packages in $packages (scripts/release)" >&2; exit 77; }
work=$(mktemp -d)
clean() {
  umount --recursive --lazy "$work"/*/proc "$work"/*/dev 2>/dev/null || true
  rm -rf --one-file-system "$work"
}
trap clean EXIT
fail() { echo "clean_roots: $*" >&2; exit 1; }

# step NAME COMMAND...: runs the command, prints its seconds, and shows its output only if it fails.
step() {
  local name=$1 begin=$EPOCHREALTIME
  shift
  "$@" >"$work/log" 2>&1 </dev/null || { cat "$work/log" >&2; fail "$name"; }
  awk -v name="$name" -v begin="$begin" -v end="$EPOCHREALTIME" 'BEGIN { printf "  %-60s %6.1f s\n", name, end - begin }'
}

bootstrap() { # SUITE
  debootstrap --variant=minbase "$1" "$work/new"
  tar --create --file "$source/build/roots/$1.tar.part" --directory "$work/new" .
  mv "$source/build/roots/$1.tar.part" "$source/build/roots/$1.tar"
  rm -rf "$work/new"
}

# new_root SUITE NAME: unpacks a root file system and sets `root` to its folder.
new_root() {
  root=$work/$2
  echo "$2 ($1)"
  mkdir -p "$root" "$source/build/roots"
  [ -e "$source/build/roots/$1.tar" ] || step "debootstrap $1" bootstrap "$1"
  tar --extract --file "$source/build/roots/$1.tar" --directory "$root"
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  cat >"$root/root/view.sh" <<'VIEW'
# Opens the window on an Xvfb display. The key p saves a picture.
set -e
cd /root
mkfifo display
Xvfb -displayfd 3 -screen 0 800x600x24 -nolisten tcp 3>display &
read -r number <display
export DISPLAY=:$number
"$1" view "$2" --json report.json &
viewer=$!
xdotool search --sync --onlyvisible --name "Lanthorn: "
until ls ./*-1.png; do kill -0 $viewer; xdotool key p; sleep 2; done
xdotool key F10
wait $viewer
VIEW
}

# inside COMMAND...: runs it in the root, with the environment of a fresh shell.
inside() {
  chroot "$root" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin DEBIAN_FRONTEND=noninteractive "$@"
}

install() { inside apt-get -qq install --yes --no-install-recommends "$@"; }

# use PROGRAM SCENES: renders with PROGRAM. The second scene has textures, so it needs OpenImageIO.
use() {
  local program=$1 scenes=$2
  step "$program render ring.pbrt -o ring.png" inside "$program" render "$scenes/ring.pbrt" -r 320x240 -p 8 -o /root/ring.png
  step "$program render heart.pbrt -o heart.exr" inside "$program" render "$scenes/gallery/heart.pbrt" -i path -r 64x48 -p 1 -o /root/heart.exr
  [ "$(head -c 4 "$root/root/ring.png" | tail -c 3)" = PNG ] || fail "ring.png is no PNG"
  step "$program info --machine" inside "$program" info --machine
  grep -q "^compiled *for $newest_level$" "$work/log" || fail "$(grep compiled "$work/log"), and not for $newest_level"
  # The C library's sines differ between distributions in the last bit: a few paths branch differently. The choices of
  # auto may fall differently, too.
  [ -e "$work/heart.exr" ] || cp "$root/root/heart.exr" "$work"
  cp "$work/heart.exr" "$root/root/first.exr"
  step "the picture of the first root" inside "$program" compare /root/heart.exr /root/first.exr --max-flip 0.01
  step "Xvfb, xdotool and OpenGL in software" install xvfb xdotool libgl1-mesa-dri libegl-mesa0 libgl1 libglx-mesa0 libegl1
  step "$program view under Xvfb" inside timeout 600 bash /root/view.sh "$program" "$scenes/ring.pbrt"
}

check_debian_packages() {
  new_root bookworm debian
  cp "$packages"/*.deb "$root/root"
  step "apt-get update" inside apt-get -qq update
  step "apt install ./lanthorn_*.deb ./lanthorn-doc_*.deb" install $(cd "$root" && ls ./root/lanthorn_*.deb ./root/lanthorn-doc_*.deb)
  use lanthorn /usr/share/lanthorn/scenes
  step "apt install ./python3-lanthorn_*.deb" install $(cd "$root" && ls ./root/python3-lanthorn_*.deb)
  step "python3 -c 'import lanthorn; ...'" inside python3 -c 'import lanthorn
picture = lanthorn.render(lanthorn.load_file("/usr/share/lanthorn/scenes/gallery/heart.pbrt"), passes=1, resolution=(64, 48), integrator="path")
assert picture["color"].shape == (48, 64, 3) and picture["color"].mean() > 0
picture.save("/root/python.exr")'
  step "the same picture" inside lanthorn compare /root/python.exr /root/heart.exr --max-mse 0
  step "apt install man-db" install man-db
  step "man lanthorn-render" inside man lanthorn-render
  grep -q -e --noise "$work/log" || fail "the man page does not have --noise"
  step "apt install ./liblanthorn-dev_*.deb ./lanthorn-mpi_*.deb" install $(cd "$root" && ls ./root/liblanthorn-dev_*.deb ./root/lanthorn-mpi_*.deb)
  step "mpirun -n 2 lanthorn render" inside mpirun --allow-run-as-root --oversubscribe -n 2 lanthorn render /usr/share/lanthorn/scenes/ring.pbrt -r 320x240 -p 8 -o /root/mpi.png
  step "the same picture" inside lanthorn compare /root/mpi.png /root/ring.png --max-mse 0
  step "apt install g++ pkgconf" install g++ pkgconf
  cp "$source/examples/render_a_file/main.cpp" "$root/root"
  step "g++ main.cpp \$(pkg-config --cflags --libs lanthorn)" \
    inside sh -c 'cd /root && g++ -std=c++20 main.cpp -o example $(pkg-config --cflags --libs lanthorn)'
  step "the example" inside /root/example /usr/share/lanthorn/scenes/ring.pbrt /root/example.png
  step "apt purge" inside sh -c 'apt-get -qq purge --yes "*lanthorn*" && ! find /usr /etc /var/lib -name "*lanthorn*" | grep -v /var/lib/dpkg'
}

check_archive() { # SUITE
  new_root "$1" "$1"
  step "unpack" tar --zstd --extract --file "$archive" --directory "$root/opt"
  folder=/opt/$(basename "$archive" -linux-x86_64.tar.zst)
  mv "$root$folder" "$root/opt/somewhere"
  step "apt-get update" inside apt-get -qq update
  use /opt/somewhere/bin/lanthorn /opt/somewhere/share/lanthorn/scenes
}

newest_level=$(/lib64/ld-linux-x86-64.so.2 --help | sed -n 's/^  \(x86-64-v[0-9]\) (supported, searched).*/\1/p' | head -n 1)
echo "The dynamic linker is to take the library for $newest_level."
[ $# -gt 0 ] || set -- debian bookworm trixie
for name in "$@"; do
  if [ "$name" = debian ]; then check_debian_packages; else check_archive "$name"; fi
  umount --recursive --lazy "$root/proc" "$root/dev"
  rm -rf --one-file-system "$root"
done
echo "Took $SECONDS s"
