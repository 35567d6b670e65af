#!/bin/sh
# Reproduces the tables and figures of Xia et al. 2016 in build/paper/index.html, presets paper and default side by side: on the
# sample characters, and on real meshes where FOCAL_EVALUATION_DATA (or ../shared/data) has them.
# usage: run.sh [--quick] [SET...]      sets of your own instead; --quick: sample characters and few shapes, two minutes instead of twenty
set -eu
cd "$(dirname "$0")/../.."
bin=build/release
out=build/paper
data=${FOCAL_EVALUATION_DATA:-../shared/data}
quick=
[ "${1:-}" != --quick ] || { quick=--quick; shift; }

cmake --preset release --log-level=NOTICE > /dev/null
cmake --build --preset release --target focal_creatures focal_paper
mkdir -p "$out"
if [ $# -eq 0 ]; then
  [ -d "$out/characters" ] || "$bin/samples/creatures/focal_creatures" "$out/characters" --train 10 --test 4
  set -- "$out/characters/humanoid" "$out/characters/quadruped"
  if [ -z "$quick" ]; then
    set -- "$@" "$out/characters/hand" "$out/characters/insect"
    for name in scape lion teddy ant hand; do
      [ ! -f "$data/$name/set.json" ] || set -- "$@" "$data/$name"
    done
  fi
fi
"$bin/samples/paper/focal_paper" $quick "$out/index.html" "$@"
echo "Look at $out/index.html"
