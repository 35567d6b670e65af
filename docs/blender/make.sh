#!/bin/sh
# Takes the pictures of docs/blender.md again: trains on sample characters in a real window and photographs it.
# Needs blender, Xvfb, xdotool and ImageMagick, and a release build.      usage: docs/blender/make.sh
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=${FOCAL_BUILD:-$(cd "$here/../.." && pwd)/build/release}
zip=${FOCAL_ADDON_ZIP:-$(ls "$build"/bindings/blender/focal_addon-*.zip)}
creatures=${FOCAL_CREATURES:-$build/samples/creatures/focal_creatures}
work=$(mktemp -d)
trap 'kill $server 2> /dev/null; rm -rf "$work"' EXIT

"$creatures" "$work/samples" --family humanoid --train 6 --test 1
"$creatures" "$work/samples" --family game_humanoid --train 0 --test 12
"$(dirname "$0")/../../samples/stock/make.sh" --build "$build" --only humanoid --characters 12 --out "$work/models"
export FOCAL_GAME_CHARACTER="$work/samples/game_humanoid/game_humanoid_10.glb" FOCAL_STOCK="$work/models/stock.focal"
mv "$work/models/humanoid.focal" "$FOCAL_STOCK"  # another model of that name is trained here
mkdir -p "$work/scripts" "$work/config" "$work/out"
export BLENDER_USER_SCRIPTS="$work/scripts" BLENDER_USER_CONFIG="$work/config" LIBGL_ALWAYS_SOFTWARE=1
exec 3> "$work/display"
Xvfb -displayfd 3 -screen 0 1280x1000x24 +extension GLX -nolisten tcp > "$work/xvfb.log" 2>&1 &
server=$!
for _ in $(seq 100); do [ -s "$work/display" ] || sleep 0.1; done
DISPLAY=:$(cat "$work/display")
export DISPLAY
blender --factory-startup --window-geometry 0 0 1280 1000 --python-exit-code 3 --python "$here/shots.py" \
  -- "$zip" "$work/samples/humanoid" "$work/out" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }

small() { convert "$@" -dither None -colors 160 -define png:compression-level=9 -strip "png8:$out"; }
for name in landmarks train detect skeleton rig; do
  out=$here/$name.png
  small "$work/out/$name.png" -crop 800x879+257+0 +repage -resize 85%
done
out=$here/maps.png
small \( "$work/out/votes.png" -crop 430x720+300+90 \) \( "$work/out/parts.png" -crop 430x720+300+90 \) +append -resize 80%
ls -l "$here"/*.png
