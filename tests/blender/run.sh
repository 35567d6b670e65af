#!/bin/sh
# Runs one test of the Blender add-on in a Blender of its own settings.
# usage: run.sh addon|window|stock|debian13 ZIP CREATURES WORK      77: what it needs is not there
#   addon, window   with models that the test trains, without a window and in one
#   stock           with nothing but the zip, which must carry the stock models
#   debian13        in the Blender 4.3 of Debian 13: what `stock` does, or `addon` where the zip has no models; also validates the zip
#   With FOCAL_EVALUATION_DATA `stock` also rigs the character of its set `wild` that has the most parts.
set -eu
kind=$1 zip=$2 creatures=$3 work=$4
here=$(cd "$(dirname "$0")" && pwd)
blender=${FOCAL_BLENDER:-blender}

skip() {
  echo "skipped: $1"
  exit 77
}
need() {
  command -v "$1" > /dev/null || skip "$1 is not installed (.ci/bootstrap.sh ci)"
}
has_models() {
  unzip -l "$zip" | grep -q 'focal/models/humanoid\.focal$'
}
make_samples() {  # SCRIPT: that it is for
  if [ "$1" = stock ]; then
    family=game_humanoid
    "$creatures" "$work/samples" --family game_humanoid --train 0 --test 1 --seed 3
  else
    family=humanoid
    "$creatures" "$work/samples" --family humanoid --train 6 --test 3
  fi
}
open_display() {
  need Xvfb
  exec 3> "$work/display"  # Xvfb chooses a free number and writes it there
  Xvfb -displayfd 3 -screen 0 800x500x24 +extension GLX -nolisten tcp > "$work/xvfb.log" 2>&1 &
  server=$!
  trap 'kill $server' EXIT
  for _ in $(seq 100); do [ -s "$work/display" ] || sleep 0.1; done
  DISPLAY=:$(cat "$work/display")
  export DISPLAY
}
enter_debian13() {  # copies what the test needs into its root; a copy, for mounts would outlive a test that is killed
  root=$("$here/debian13.sh") || exit $?
  inside=/focal-test-$$
  trap 'rm -rf "$root$inside"' EXIT
  mkdir "$root$inside" "$root$inside/out" "$root$inside/tests" "$root$inside/user" "$root$inside/wild"
  cp -r "$zip" "$work/samples" "$root$inside"
  cp -r "$here/../../samples/templates" "$root$inside/samples"  # where the scripts look for them
  cp -r "$here" "$root$inside/tests"
  if [ -d "$FOCAL_WILD" ]; then cp "$FOCAL_WILD"/*.glb "$root$inside/wild"; fi
  run="chroot $root env HOME=$inside/user FOCAL_WILD=$inside/wild BLENDER_USER_RESOURCES=$inside/user"
  samples=$inside/samples/$family out=$inside/out scripts=$inside/tests/$(basename "$here") zip=$inside/$(basename "$zip")
}

rm -rf "$work"
mkdir -p "$work/scripts" "$work/config" "$work/out"
export FOCAL_WILD="${FOCAL_EVALUATION_DATA:-/nowhere}/wild/dev"
export BLENDER_USER_SCRIPTS="$work/scripts" BLENDER_USER_CONFIG="$work/config" LIBGL_ALWAYS_SOFTWARE=1
options="--factory-startup --python-exit-code 3" script=$kind run="" out=$work/out scripts=$here
case $kind in
  window)
    need "$blender"
    make_samples window
    open_display
    options="$options --no-window-focus --window-geometry 0 0 800 500 --enable-event-simulate"
    ;;
  debian13)
    script=addon
    if has_models; then script=stock; fi
    make_samples "$script"
    enter_debian13
    blender=blender
    unset BLENDER_USER_SCRIPTS BLENDER_USER_CONFIG
    $run blender --command extension validate "$zip" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
    options="$options -b"
    ;;
  *)
    need "$blender"
    if [ "$kind" = stock ] && ! has_models; then
      skip "the zip has no stock models; samples/stock/make.sh makes them, and the next build packs them"
    fi
    make_samples "$kind"
    options="$options -b"
    ;;
esac
# shellcheck disable=SC2086  # the options are words
$run "$blender" $options --python "$scripts/$script.py" -- "$zip" "${samples:-$work/samples/$family}" "$out" > "$work/log" 2>&1 || {
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
