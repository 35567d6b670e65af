#!/bin/sh
# Pictures of votes like the paper's Figs. 7-11 in build/paper/votes.html: of the sample characters, and of real meshes where
# FOCAL_EVALUATION_DATA (or ../shared/data) has them; some minutes a set, since preset paper analyses every mesh in full.
# usage: run.sh [SET...]      sets of your own instead
set -eu
cd "$(dirname "$0")/../.."
bin=build/release
out=build/paper
data=${FOCAL_EVALUATION_DATA:-../shared/data}

cmake --preset release --log-level=NOTICE > /dev/null
cmake --build --preset release --target focal_creatures focal_paper
mkdir -p "$out"
if [ $# -eq 0 ]; then
  [ -d "$out/characters" ] || "$bin/samples/creatures/focal_creatures" "$out/characters" --train 6 --test 1
  set -- "$out/characters/humanoid" "$out/characters/hand"
  for name in lion teddy; do
    [ -f "$data/$name/set.json" ] && set -- "$@" "$data/$name"
  done
fi
"$bin/samples/paper/focal_paper" "$out/votes.html" "$@"
echo "Look at $out/votes.html"
