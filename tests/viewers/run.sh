#!/bin/sh
# Has focal write glTF files of every kind, from the sample characters and, with FOCAL_EVALUATION_DATA, from real ones, and has
# check.mjs judge them by the Khronos validator and three.js. Exit status 77: without node or its packages nothing is judged.
# usage: run.sh FOCAL FOCAL_CREATURES FOCAL_QUICK_MODEL FOLDER TOOLS      TOOLS: where node_modules lies
set -eu
here=$(cd "$(dirname "$0")" && pwd)
focal=$1 creatures=$2 quick_model=$3 folder=$4 tools=$5
for package in gltf-validator three @pixiv/three-vrm; do
  if ! command -v node > /dev/null || ! [ -f "$tools/node_modules/$package/package.json" ]; then
    echo "viewers: skipped: node or its package $package is missing; .ci/bootstrap.sh ci fetches them"
    exit 77
  fi
done
rm -rf "$folder"
mkdir -p "$folder"

written() { printf '%s\t%s\t%s\n' "$@" >> "$folder/list"; }  # FILE INPUT HOW

learn() {  # NAME CHARACTER...
  model=$folder/$1.focal
  shift
  "$quick_model" "$model" "$@"
}

rig() {  # INPUT OUT [ARGUMENTS OF focal rig]
  input=$1 out=$2
  shift 2
  # Files are judged here, not rigs: one whose verdict is "failed" (a triceratops by a velociraptor) is written by --keep-failed,
  # with status 1. Any other failure leaves no file.
  status=0
  "$focal" rig "$model" "$input" -o "$out" --keep-failed --json --quiet "$@" > "$out.json" || status=$?
  if [ "$status" -gt 1 ] || ! [ -s "$out" ]; then
    echo "viewers: focal rig of $input ended with status $status" >&2
    exit 1
  fi
  written "$out" "$input" "rig $*"
}

mark() {  # INPUT OUT [ARGUMENTS OF focal detect]
  input=$1 out=$2
  shift 2
  "$focal" detect "$model" "$input" -o "$out" --quiet "$@"
  written "$out" "$input" detect
}

everything() {  # INPUT NAME
  stem=$folder/$2
  rig "$1" "$stem.rigged.glb"
  mark "$1" "$stem.marked.glb" --votes "$stem.votes.glb"
  written "$stem.votes.glb" "$1" votes
  "$focal" segment "$model" "$1" -o "$stem.parts.glb" --quiet
  written "$stem.parts.glb" "$1" parts
}

"$creatures" "$folder/set" --train 1 --test 1 > /dev/null
for family in hand insect quadruped humanoid; do
  learn $family "$folder/set/$family/${family}_00.rig.glb"
  everything "$folder/set/$family/${family}_01.glb" $family
done
mesh=$folder/set/humanoid/humanoid_01.glb character=$folder/set/humanoid/humanoid_00.rig.glb
rig "$mesh" "$folder/animated.glb" --names mixamo --animations "$character"
rig "$mesh" "$folder/at_rest.glb" --rest-pose --symmetric --names rigify
echo '{"name": "Sample", "authors": ["somebody"]}' > "$folder/meta.json"
rig "$mesh" "$folder/avatar.glb" --pose t --vrm "$folder/meta.json"
rig "$folder/humanoid.rigged.glb" "$folder/again.glb" --names unreal
rig "$character" "$folder/second_skeleton.glb"  # beside the character's own, whose bones have the same names
mark "$character" "$folder/character_marked.glb"
# Joints called like a landmark, like each other without the dot, and as viewers will not have it.
cat > "$folder/template.json" << END
{"format": "focal-skeleton-template", "version": 1, "joints": [
  {"name": "head tip", "centre": ["spine +z", "spine -z"]},
  {"name": "hand.1", "parent": "head tip", "surface": ["leftHand tip"]},
  {"name": "头 [1]/a:b", "parent": "head tip", "surface": ["rightHand tip"]}]}
END
rig "$mesh" "$folder/by_hand.glb" --template "$folder/template.json"
node "$here/to_gltf.mjs" "$mesh" "$folder/text.gltf"
rig "$folder/text.gltf" "$folder/text_rigged.gltf"
mark "$folder/text.gltf" "$folder/text_marked.gltf"

if [ -d "${FOCAL_EVALUATION_DATA:-}/rigs" ]; then
  rigs=$FOCAL_EVALUATION_DATA/rigs
  learn animals "$rigs/alpaca.glb" "$rigs/donkey.glb" "$rigs/fox.glb" "$rigs/husky.glb" "$rigs/wolf.glb"
  everything "$rigs/horse.glb" horse
  rig "$rigs/shiba.glb" "$folder/shiba.rigged.glb" --animations "$rigs/fox.glb"
  rig "$rigs/bevy_fox.glb" "$folder/bevy_fox.rigged.glb"
  while read -r from to; do
    learn "$from" "$rigs/$from.glb"
    rig "$rigs/$to.glb" "$folder/$to.rigged.glb"
    mark "$rigs/$to.glb" "$folder/$to.marked.glb"
  done << END
farm_cow farm_pig
cesium_man rigged_figure
rigged_figure cesium_man
kaykit_knight kaykit_mage
webxr_hand_left webxr_hand_left
man_farmer man_worker
velociraptor triceratops
END
else
  echo "viewers: FOCAL_EVALUATION_DATA has no rigs: only sample characters"
fi
if [ -d "${FOCAL_EVALUATION_DATA:-}/makehuman" ]; then
  learn makehuman "$FOCAL_EVALUATION_DATA/makehuman/mh00a.rig.glb"
  everything "$FOCAL_EVALUATION_DATA/makehuman/mh01b.glb" makehuman
fi
FOCAL_VIEWERS=$tools node "$here/check.mjs" "$folder/list"
