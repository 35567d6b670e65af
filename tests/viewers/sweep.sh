#!/bin/sh
# Has focal write over every .glb of some folders - landmarks, a skeleton, other weights - and has check.mjs judge all of it by the
# Khronos validator and three.js. Run by hand: some 300 files take ten minutes. Prints what focal refused.
# Blender loads all of it, where it is installed.
# usage: FOCAL_EVALUATION_DATA=DATA sweep.sh [EVERY [BUILD [OUT]]]
#   DATA/rigs, DATA/wild/dev (the rigged ones), DATA/makehuman, DATA/../cases, and sample characters of every family
#   EVERY: 4 takes every fourth of wild/dev; 1: all. BUILD: build/release. OUT: where files go, build/sweep
set -eu
here=$(cd "$(dirname "$0")" && pwd)
project=$here/../..
every=${1:-1} build=${2:-$project/build/release} out=${3:-$project/build/sweep} data=$FOCAL_EVALUATION_DATA
focal=${FOCAL_COMMAND:-$build/bindings/cli/focal}
rm -rf "$out"
mkdir -p "$out"
"$build/samples/creatures/focal_creatures" "$out/set" --train 1 --test 0 > /dev/null
model=$out/quick.focal  # files are judged, not rigs
hero=$out/set/humanoid/humanoid_00.rig.glb
"$focal" train --rigs "$hero" -o "$model" --eigenpairs 40 --trees 3 --proxy 500 --quiet

number=0 refused=0
write() {  # INPUT HOW VERB ARGUMENT...
  input=$1 how=$2
  shift 2
  number=$((number + 1))
  file=$out/$number.glb status=0
  "$focal" "$@" -o "$file" --quiet > "$file.json" 2> "$file.err" || status=$?
  if [ -s "$file" ]; then  # with --keep-failed a rig whose verdict is "failed" is written, and ends with 1
    printf '%s\t%s\t%s\n' "$file" "$input" "$how" >> "$out/list"
  else
    refused=$((refused + 1))
    printf 'sweep: focal %s %s ended with %s: %s\n' "$1" "$input" "$status" "$(head -n 1 "$file.err")"
  fi
}

has_skin() { head -c 200000 "$1" | grep -aq '"skins"'; }

all() {  # INPUT
  write "$1" "rig" rig "$model" "$1" --keep-failed --json
  write "$1" "detect" detect "$model" "$1"
  if has_skin "$1"; then write "$1" "keep" rig --keep-skeleton "$1" --json; fi
}

bare=$out/set/humanoid/humanoid_00.glb
write "$bare" "rig --animations $hero" rig "$model" "$bare" --animations "$hero" --keep-failed --json
wild=$(ls "$data"/wild/dev/*.rig.glb | awk "NR % $every == 0")
for input in "$out"/set/*/*.glb "$data"/rigs/*.glb $wild "$data"/makehuman/*.rig.glb "$data"/../cases/*/*.glb; do
  if [ -f "$input" ]; then all "$input"; fi
done
echo "sweep: $number runs, $refused refused"
status=0
FOCAL_VIEWERS=$project/build/tools node "$here/check.mjs" "$out/list" || status=1
if command -v blender > /dev/null; then
  blender --background --factory-startup --python-exit-code 3 --python "$here/in_blender.py" -- "$out/list" > "$out/blender.log" 2>&1 ||
    status=1
  grep '^blender' "$out/blender.log" || status=1
fi
exit $status
