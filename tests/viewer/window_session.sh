#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
#
# Usage: tests/viewer/window_session.sh LANTHORN [SCREENSHOT_FOLDER]
# A session in the window of `lanthorn view` on an Xvfb display, operated by xdotool: opens, orbits, drags a light, switches
# methods (direct, ambient, ispm, voxelcones and an offline one), saves. Exits with 77, which ctest shows as skipped, if Xvfb
# or xdotool is missing. Screenshots need ImageMagick's import.
set -euo pipefail
program=$(realpath "$1")
shots=${2:+$(realpath "$2")}
for tool in Xvfb xdotool; do
  command -v "$tool" >/dev/null || { echo "SKIPPED, NOT TESTED: no $tool (scripts/install-packages test)" >&2; exit 77; }
done

work=$(mktemp -d)
screen_pid=
viewer_pid=
clean() {
  [ -z "$viewer_pid" ] || kill "$viewer_pid" 2>/dev/null || true
  [ -z "$screen_pid" ] || kill "$screen_pid" 2>/dev/null || true
  rm -rf "$work"
}
trap clean EXIT
fail() {
  echo "window_session: $*" >&2
  cat viewer.log >&2 || true
  shot failure
  exit 1
}
shot() { [ -z "$shots" ] || import -window root "$shots/$1.png" || true; }
# Waits up to two minutes for a condition: the machine may be busy.
await() {
  local what=$1
  shift
  for _ in $(seq 1200); do
    if "$@" >/dev/null 2>&1; then return; fi
    kill -0 "$viewer_pid" 2>/dev/null || fail "the viewer has ended before: $what"
    sleep 0.1
  done
  fail "not within two minutes: $what"
}
# Sleeps for about the given number of frames; `frame_seconds` is measured below.
frame_seconds=0.3
frames() { sleep "$(awk -v n="${1:-3}" -v t="$frame_seconds" 'BEGIN { print n * t }')"; }

cd "$work"
cat >room.pbrt <<'SCENE'
LookAt 0 1 4.2  0 1 0  0 1 0
Camera "perspective" "float fov" [34]
Film "rgb" "integer xresolution" [320] "integer yresolution" [180]
WorldBegin
LightSource "point" "rgb I" [4 3.4 2.6] "point3 from" [0 1.6 0.2]
Material "diffuse" "rgb reflectance" [.7 .7 .68]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1.8 0 1  1.8 0 1  1.8 0 -1  -1.8 0 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1.8 2 1  1.8 2 1  1.8 2 -1  -1.8 2 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1.8 0 -1  1.8 0 -1  1.8 2 -1  -1.8 2 -1]
Material "diffuse" "rgb reflectance" [.65 .1 .06]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [1.8 0 -1  1.8 0 1  1.8 2 1  1.8 2 -1]
Material "diffuse" "rgb reflectance" [.12 .4 .1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1.8 0 1  -1.8 0 -1  -1.8 2 -1  -1.8 2 1]
Material "diffuse" "rgb reflectance" [.5 .55 .7]
ObjectBegin "ball"
  Shape "sphere" "float radius" [.35]
ObjectEnd
AttributeBegin
  Translate -.7 .35 0
  ObjectInstance "ball"
AttributeEnd
SCENE

# Xvfb chooses a free display and tells its number.
exec 3<>display
Xvfb -displayfd 3 -screen 0 1000x900x24 -nolisten tcp >xvfb.log 2>&1 &
screen_pid=$!
for _ in $(seq 300); do [ -s display ] && break; sleep 0.1; done
export DISPLAY=:$(head -1 display)
unset WAYLAND_DISPLAY

"$program" view room.pbrt -n 5000 --json report.json >viewer.log 2>&1 &
viewer_pid=$!
await "a window" xdotool search --onlyvisible --name "Lanthorn: room.pbrt"
window=$(xdotool search --onlyvisible --name "Lanthorn: room.pbrt" | head -1)
xdotool windowfocus "$window" || true
eval "$(xdotool getwindowgeometry --shell "$window")"
# The picture is centred in the area left of the panel (330 pixels wide) and fills it as far as possible.
area=$((WIDTH - 330))
size=$(awk -v w="$area" -v h="$HEIGHT" 'BEGIN { a = w / 320; b = h / 180; print a < b ? a : b }')
pixel() { # x y in the picture: x y on the screen
  awk -v x="$1" -v y="$2" -v s="$size" -v w="$area" -v h="$HEIGHT" -v left="$X" -v top="$Y" \
    'BEGIN { printf "%d %d\n", left + (w - 320 * s) / 2 + x * s, top + (h - 180 * s) / 2 + y * s }'
}
drag() { # button, from x y, to x y
  xdotool mousemove $(pixel "$2" "$3")
  frames 2
  xdotool mousedown "$1"
  frames 2
  for step in 1 2 3; do
    xdotool mousemove $(pixel $(($2 + ($4 - $2) * step / 3)) $(($3 + ($5 - $3) * step / 3)))
    frames 1.2
  done
  xdotool mouseup "$1"
  frames 2
}
save_png() { # number of the file
  xdotool key p
  await "picture $1" test -s "room-$1.png"
  frames 2
}
differ() { ! cmp -s "$1" "$2" || fail "$1 and $2 are the same picture: $3"; }

save_png 1
begin=$(date +%s%N)
save_png 2
frame_seconds=$(awk -v a="$begin" -v b="$(date +%s%N)" 'BEGIN { t = (b - a) / 3e9; print t < 0.1 ? 0.1 : t }')
shot 1-start
# A click selects the ball even if the pointer comes from far away between two frames. The camera stays.
mse() { "$program" compare "$1" "$2" | awk '$1 == "MSE" { print $2 }'; }
xdotool mousemove $(pixel 20 20)
frames 3
xdotool mousemove $(pixel 209 135) click 1
frames 3
save_png 3
mv room-3.png room-click.png
awk -v noise="$(mse room-1.png room-2.png)" -v click="$(mse room-2.png room-click.png)" \
  'BEGIN { exit !(click < 4 * noise + 1e-5) }' || fail "a click moved the camera"
drag 1 250 140 290 150
save_png 3
shot 2-orbit
differ room-2.png room-3.png "the camera did not orbit"
xdotool key r
frames
# The file's camera shows the light at (0, 1.6, 0.2) at this pixel.
light=$(awk 'BEGIN { t = 3.1415926536 * 34 / 360; t = sin(t) / cos(t); print int(160), int(90 - 90 * 0.6 / (4.0 * t)) }')
set -- $light
drag 1 "$1" "$2" $(($1 + 60)) $(($2 + 30))
save_png 4
shot 3-light
differ room-2.png room-4.png "the light did not move"
xdotool key o
await "a saved scene" test -s room-view-1.pbrt
grep -q AttributeBegin room-view-1.pbrt || fail "the saved scene has no moved light"
xdotool key 1
frames
save_png 5
shot 4-direct
differ room-4.png room-5.png "direct light alone looks like photons"
xdotool key 2
frames
save_png 6
shot 5-ambient
differ room-5.png room-6.png "ambient light is not there"
xdotool key 5
frames 3
save_png 7
shot 6-cones
differ room-6.png room-7.png "light of voxels is not there"
set -- $light
drag 1 $(($1 + 60)) $(($2 + 30)) $(($1 - 40)) $(($2 + 20))
save_png 8
shot 7-cones-light
differ room-7.png room-8.png "the light did not move in the voxels"
drag 1 250 140 290 150
save_png 9
differ room-8.png room-9.png "the camera did not orbit around the voxels"
xdotool key 6
sleep 1
frames 6
save_png 10
shot 8-offline
differ room-9.png room-10.png "the offline method is not there"
# Noisy pictures make large files.
size_becomes() { # smaller|larger than 3/4 of the noisy picture
  for _ in $(seq 30); do
    sleep 1
    save_png 11
    mv room-11.png now.png
    [ $((4 * $(stat -c %s now.png) < 3 * $(stat -c %s room-10.png))) = $([ "$1" = smaller ] && echo 1 || echo 0) ] && return
  done
  return 1
}
xdotool key n
size_becomes smaller || fail "the picture was not denoised"
shot 9-denoised
xdotool key n
size_becomes larger || fail "the picture is still denoised"
xdotool key 3
frames 4
save_png 11
shot 10-photons
differ now.png room-11.png "the photons did not come back"
xdotool key F10
for _ in $(seq 300); do kill -0 "$viewer_pid" 2>/dev/null || break; sleep 0.1; done
wait "$viewer_pid" || fail "the viewer did not end well"
viewer_pid=
grep -q '"photons_per_bounce"' report.json || fail "no report"
[ ! -s viewer.log ] || fail "the viewer said something"
grep -q '"method": "ispm"' report.json || fail "the last method was not ispm"
# The saved scene is the one shown: rendered again without a window, it is equally bright up to noise.
check_brightness() { # picture of the window, method
  "$program" view room-view-1.pbrt --headless -i "$2" -p 8 -n 5000 -o again.png
  local ratio
  ratio=$("$program" compare "$1" again.png | awk '/mean ratio/ { print $3 }')
  awk -v r="$ratio" 'BEGIN { exit !(r > 0.97 && r < 1.03) }' || fail "$1 is $ratio times as bright as $2 without a window"
}
check_brightness room-4.png ispm
check_brightness room-5.png direct
check_brightness room-7.png voxelcones
"$program" render room-view-1.pbrt -i path -p 1 -o offline.png -q 2>render.log
! grep -q "given twice" render.log || fail "the saved scene has parameters twice, though the light was only moved"
echo "window_session: passed"
