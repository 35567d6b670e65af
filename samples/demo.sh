#!/bin/sh
# The whole way: installs what is missing, builds, makes sample characters, learns the skeleton of rigged ones and puts it on others
# never seen; learns landmarks from ten of a kind, finds them on others, and measures. Fails above 1.5 edges of mean error or
# with a left/right flip.
set -eu
cd "$(dirname "$0")/.."
bin=build/release
out=build/demo
worst_mean=1.5
families="humanoid quadruped hand insect"
rigged=$out/characters/game_humanoid/game_humanoid  # 20 teach
unseen_rigs="20 21 22 23"

. .ci/steps.sh

build() {
  cmake --preset release --log-level=NOTICE > /dev/null
  cmake --build --preset release --target focal_cli focal_creatures focal_picture
}

number() {  # KEY FILE: the value of a top-level key of a report
  sed -n "s/^ \"$1\": \([^,]*\),\{0,1\}\$/\1/p" "$2"
}

learn_rigs() { "$bin"/bindings/cli/focal train --rigs "$rigged"_0?.rig.glb "$rigged"_1?.rig.glb -o "$out/rigs.focal"; }

put_rigs_on() {  # characters that did not teach; a rig whose verdict is failed is written all the same, to be looked at
  for number in $unseen_rigs; do
    "$bin"/bindings/cli/focal rig "$out/rigs.focal" "${rigged}_$number.glb" -o "$out/rigged_$number.glb" --quiet --keep-failed \
      --json > "$out/rigged_$number.json" || [ -s "$out/rigged_$number.glb" ]
  done
}

learn() { "$bin"/bindings/cli/focal train "$out/characters/$1" -o "$out/$1.focal"; }

measure() { "$bin"/bindings/cli/focal eval "$out/$1.focal" "$out/characters/$1" --quiet --json > "$out/$1.eval.json"; }

find_on() {  # FAMILY: its first character of the test split
  unseen=$(sed -n 's/^   "name": "\(.*\)",\{0,1\}$/\1/p' "$out/$1.eval.json" | head -n 1)
  for kind in landmarks.json glb; do
    "$bin"/bindings/cli/focal detect "$out/$1.focal" "$out/characters/$1/$unseen.glb" -o "$out/$1.$kind" --quiet
  done
  cp "$out/characters/$1/$unseen.glb" "$out/$1.unseen.glb"
}

draw() {
  panels=
  for family in $families; do
    case $family in
      insect) pitch=40 ;;
      *) pitch=10 ;;
    esac
    panels="$panels $out/$family.unseen.glb,$out/$family.landmarks.json,$family,$pitch"
  done
  # shellcheck disable=SC2086  # the panels are words
  "$bin"/samples/picture/focal_picture "$out/picture.svg" $panels
  panels=
  for number in $unseen_rigs; do panels="$panels $out/rigged_$number.glb,$out/rigged_$number.json,,5,25"; done
  # shellcheck disable=SC2086
  "$bin"/samples/picture/focal_picture "$out/rigged.svg" $panels
}

rm -rf "$out"
mkdir -p "$out"
step "install missing packages" .ci/bootstrap.sh
step "build" build
step "make characters" "$bin"/samples/creatures/focal_creatures "$out/characters" --train 10 --test 5
step "make rigged characters of games" "$bin"/samples/creatures/focal_creatures "$out/characters" --family game_humanoid --train 20 --test 4
step "learn the skeleton of twenty characters" learn_rigs
step "put it on four that did not teach" put_rigs_on
for family in $families; do
  step "learn the landmarks of ten ${family}s" learn "$family"
  step "find them on five unseen ${family}s and measure" measure "$family"
  step "write one ${family}'s landmarks and landmarked glTF" find_on "$family"
done
step "draw the pictures" draw

print_times
echo "Rigs of characters never seen:"
for number in $unseen_rigs; do
  sed -n "s/^ \"verdict\": \"\([a-z]*\)\",\{0,1\}\$/  rigged_$number.glb: \1/p" "$out/rigged_$number.json"
done
echo "On characters never seen (error in mean edge lengths of the mesh):"
failed=0
for family in $families; do
  mean=$(number mean_edges "$out/$family.eval.json")
  flips=$(number flipped_meshes "$out/$family.eval.json")
  verdict=good
  awk -v m="$mean" -v w="$worst_mean" -v f="$flips" 'BEGIN { exit !(m != "" && m + 0 <= w && f + 0 == 0) }' || {
    verdict="NOT GOOD ENOUGH"
    failed=1
  }
  awk -v n="$family" -v m="$mean" -v f="$flips" -v v="$verdict" \
    'BEGIN { printf "%10s  mean %.2f edges, flipped left/right: %s  %s\n", n, m, f == "null" ? "no pairs" : f, v }'
done
echo
echo "Look at:"
for file in rigged.svg rigged_20.glb picture.svg humanoid.landmarks.json humanoid.glb; do
  echo "  $out/$file"
done
echo "  and the same for the other families; the models are $out/*.focal"
exit $failed
