#!/bin/sh
# Runs one test of the Blender add-on in a Blender of its own settings.
# usage: run.sh addon|window|stock ZIP CREATURES WORK      77: what it needs is not there
set -eu
kind=$1 zip=$2 creatures=$3 work=$4 family=humanoid
here=$(cd "$(dirname "$0")" && pwd)
blender=${FOCAL_BLENDER:-blender}

need() {
  command -v "$1" > /dev/null || {
    echo "skipped: $1 is not installed (.ci/bootstrap.sh ci)"
    exit 77
  }
}
need "$blender"

rm -rf "$work"
mkdir -p "$work/scripts" "$work/config" "$work/out"
export BLENDER_USER_SCRIPTS="$work/scripts" BLENDER_USER_CONFIG="$work/config" LIBGL_ALWAYS_SOFTWARE=1
options="--factory-startup --python-exit-code 3"
if [ "$kind" = window ]; then
  need Xvfb
  "$creatures" "$work/samples" --family humanoid --train 3 --test 1
  exec 3> "$work/display"  # Xvfb chooses a free number and writes it there
  Xvfb -displayfd 3 -screen 0 800x500x24 +extension GLX -nolisten tcp > "$work/xvfb.log" 2>&1 &
  server=$!
  trap 'kill $server' EXIT
  for _ in $(seq 100); do [ -s "$work/display" ] || sleep 0.1; done
  DISPLAY=:$(cat "$work/display")
  export DISPLAY
  options="$options --no-window-focus --window-geometry 0 0 800 500 --enable-event-simulate"
elif [ "$kind" = stock ]; then
  unzip -l "$zip" | grep -q 'focal/models/humanoid\.focal$' || {
    echo "skipped: the zip has no stock models; samples/stock/make.sh makes them, and the next build packs them"
    exit 77
  }
  family=game_humanoid
  "$creatures" "$work/samples" --family game_humanoid --train 0 --test 1 --seed 3
  options="$options -b"
else
  "$creatures" "$work/samples" --family humanoid --train 6 --test 3
  options="$options -b"
fi
# shellcheck disable=SC2086  # the options are words
"$blender" $options --python "$here/$kind.py" -- "$zip" "$work/samples/$family" "$work/out" > "$work/log" 2>&1 || {
  code=$?
  cat "$work/log"
  exit $code
}
# A script that never came to its end must not pass.
grep -q '^all passed$' "$work/log" || {
  cat "$work/log"
  exit 1
}
grep '^ *[0-9.]* s  ' "$work/log"
