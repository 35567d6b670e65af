#!/bin/sh
# Whether confidence and category fit mean what they say: clean test meshes of seven sets, each model put to two test meshes of
# every foreign set, and spoiled meshes of one set, pooled. Not a test with bounds: the figures go into docs/accuracy.md.
#   tests/accuracy/confidence.sh [--seed 0] [--build DIR]
set -eu
cd "$(dirname "$0")/../.."
seed=0 build=build/release out=build/accuracy
sets="faust5k human07 teddy ant hand lion tosca_cat"
while [ $# -gt 0 ]; do
  case $1 in
    --seed) seed=$2 ;;
    --build) build=$2 ;;
    *) echo "unknown option $1" >&2; exit 2 ;;
  esac
  shift 2
done
data=${FOCAL_EVALUATION_DATA:?set it to the folder of the evaluation sets}
tests/accuracy/run.sh --sets "$sets" --seeds "$seed" --build "$build"

kind_of() {
  case $1 in
    faust5k | human07) echo human ;;
    lion | tosca_cat) echo feline ;;
    *) echo "$1" ;;
  esac
}
two_tests_of() { python3 -c 'import json, sys; print(*json.load(open(sys.argv[1]))["test"][:2])' "$data/$1/set.json"; }

reports=""
for set in $sets; do
  model=$out/$set.default.$seed
  reports="$reports $model.best.json"
  for other in $sets; do
    [ "$(kind_of "$set")" != "$(kind_of "$other")" ] || continue
    for mesh in $(two_tests_of "$other"); do
      report=$model.best.on.$other.$mesh.json
      "$build/bindings/cli/focal" detect "$model.focal" "$data/$other/$mesh.glb" --quiet --json > "$report"
      reports="$reports $report"
    done
  done
done
spoiled=$out/faust5k.default.$seed.spoiled.json
FOCAL_BUILD=$build tests/robustness/run.sh --limit 6 --json "$spoiled" --model "$out/faust5k.default.$seed.focal" >&2
# shellcheck disable=SC2086 -- names of our own making, without blanks
exec python3 tests/accuracy/confidence.py $reports "$spoiled"
