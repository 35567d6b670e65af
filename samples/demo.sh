#!/bin/sh
# The full demo: installs dependencies, builds, trains a small stock model, and uses it to rig and animate characters that it has not
# seen; then learns the landmarks of ten characters, finds them on others, and measures the errors.
# Fails if fewer than half of the rigs are usable, if the mean error is above 1.5 edges, or if left and right are exchanged.
set -eu
cd "$(dirname "$0")/.."
bin=build/release
out=build/demo
teachers=12  # training characters of the stock model here; samples/stock/make.sh uses more, which is better but takes minutes
unseen="10 3 5 9"  # characters that work well; docs/accuracy.md has the results on all kinds
animation=stretch  # of a sample character
dancer=$out/characters/game_humanoid/game_humanoid_05.rig.glb
worst_mean=1.5
FOCAL_MODELS=$PWD/$out/models  # where `focal rig humanoid` finds it
export FOCAL_MODELS

. .ci/steps.sh

build() {
  cmake --preset release --log-level=NOTICE > /dev/null
  cmake --build --preset release --target focal_cli focal_creatures focal_picture
}

make_stock() { samples/stock/make.sh --only humanoid --characters "$teachers" --out "$out/models"; }

make_characters() {
  "$bin"/samples/creatures/focal_creatures "$out/characters" --family game_humanoid --train 0 --test 12
  "$bin"/samples/creatures/focal_creatures "$out/characters" --family humanoid --train 10 --test 5
}

character() { printf '%s/characters/game_humanoid/game_humanoid_%02d.glb' "$out" "$1"; }

put_rigs_on() {  # a rig whose verdict is failed is written too, for inspection
  for number in $unseen; do
    "$bin"/bindings/cli/focal rig humanoid "$(character "$number")" -o "$out/rigged_$number.glb" --animations "$dancer" --quiet \
      --keep-failed --json > "$out/rigged_$number.json" || [ -s "$out/rigged_$number.glb" ]
  done
}

draw_rigs() {  # the skeletons above, the animation of the first below
  for number in $unseen; do printf '%s,%s,,5,25\n' "$out/rigged_$number.glb" "$out/rigged_$number.json"; done > "$out/panels"
  for second in 0 0.4 0.7 1; do printf '%s,,%s s,5,25,%s,%s\n' "$out/rigged_${unseen%% *}.glb" "$second" "$animation" "$second"; done >> "$out/panels"
  tr '\n' '\0' < "$out/panels" | xargs -0 "$bin"/samples/picture/focal_picture --columns 4 "$out/rigged.svg"
  rm "$out/panels"
}

learn() { "$bin"/bindings/cli/focal train "$out/characters/humanoid" -o "$out/landmarks.focal"; }

measure() { "$bin"/bindings/cli/focal eval "$out/landmarks.focal" "$out/characters/humanoid" --quiet --json > "$out/landmarks.eval.json"; }

find_on() {  # the first character of the test split
  found=$out/characters/humanoid/humanoid_10
  for kind in landmarks.json glb; do
    "$bin"/bindings/cli/focal detect "$out/landmarks.focal" "$found.glb" -o "$out/found.$kind" --quiet
  done
  "$bin"/samples/picture/focal_picture "$out/landmarks.svg" "$found.glb,$out/found.landmarks.json,,10"
}

value() {  # KEY FILE: the value of a top-level key of a report
  sed -n "s/^ \"$1\": \"\{0,1\}\([^,\"]*\)\"\{0,1\},\{0,1\}\$/\1/p" "$2"
}

report_rigs() {
  usable=0 all=0
  for number in $unseen; do
    verdict=$(value verdict "$out/rigged_$number.json")
    all=$((all + 1))
    [ "$verdict" = failed ] || usable=$((usable + 1))
    echo "  rigged_$number.glb: $verdict"
  done
  [ $((2 * usable)) -ge $all ]
}

report_landmarks() {
  mean=$(value mean_edges "$out/landmarks.eval.json")
  flips=$(value flipped_meshes "$out/landmarks.eval.json")
  awk -v m="$mean" -v f="$flips" 'BEGIN { printf "  mean error %.2f edges of the mesh, flipped left/right: %s\n", m, f }'
  awk -v m="$mean" -v w="$worst_mean" -v f="$flips" 'BEGIN { exit !(m != "" && m + 0 <= w && f + 0 == 0) }'
}

rm -rf "$out"
mkdir -p "$out"
step "install missing packages" .ci/bootstrap.sh
step "build the command and the sample programs" build
step "make a stock model of $teachers characters" make_stock
step "make characters for testing" make_characters
step "rig and animate four of them" put_rigs_on
step "draw them" draw_rigs
step "learn the landmarks of ten characters" learn
step "find them on five others and measure" measure
step "write and draw one character's landmarks" find_on

print_times
failed=0
echo "Rigs of unseen characters, by a stock model of $teachers characters (samples/stock/make.sh makes the full one, of 60):"
report_rigs || failed=1
echo "Landmarks of unseen characters:"
report_landmarks || failed=1
[ $failed -eq 0 ] || echo "NOT GOOD ENOUGH"
echo
echo "Results:"
for file in rigged.svg "rigged_${unseen%% *}.glb" landmarks.svg found.glb found.landmarks.json; do echo "  $out/$file"; done
exit $failed
