#!/bin/sh
# Makes the stock models humanoid, quadruped and hand from characters of samples/creatures: nothing that anybody owns teaches them.
# The seeds are fixed: one build makes the same files again. Minutes on two cores. The models are no part of the sources.
# usage: samples/stock/make.sh [--out FOLDER] [--build FOLDER] [--only NAME,...] [--characters N] [--threads N]
#   --out         where NAME.focal go (BUILD/models, where the build's own library and command find them, and where
#                 `cmake --install` and the Python package take them from)
#   --build       the build whose commands are used (build/release)
#   --only        which of the models
#   --characters  that teach each model, at most: few for a trial (60 humanoids, 40 quadrupeds, 16 hands)
#   --threads     of focal (0: one a core)
set -eu
called=$PWD
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
out="" build=build/release only=humanoid,quadruped,hand most=1000 threads=0
while [ $# -gt 0 ]; do
  case $1 in
    --help|-h) sed -n '2,/^set /s/^# //p' "$here/make.sh"; exit 0 ;;
    --out|--build|--only|--characters|--threads) [ $# -gt 1 ] || { echo "$1 needs a value" >&2; exit 2; } ;;
    *) echo "unknown option $1" >&2; exit 2 ;;
  esac
  case $1 in
    --out) out=$2; case $out in /*) ;; *) out=$called/$out ;; esac ;;
    --build) build=$2; case $build in /*) ;; *) build=$called/$build ;; esac ;;
    --only) only=$2 ;;
    --characters) most=$2 ;;
    --threads) threads=$2 ;;
  esac
  shift 2
done
: "${out:=$build/models}"
for program in "$build/bindings/cli/focal" "$build/samples/creatures/focal_creatures"; do
  [ -x "$program" ] || { echo "$program is missing: cmake --preset release && cmake --build --preset release --target focal_cli focal_creatures" >&2; exit 2; }
done
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM

make_model() {  # NAME FAMILY CHARACTERS
  count=$(( $3 < most ? $3 : most ))
  "$build/samples/creatures/focal_creatures" "$work" --family "$2" --train "$count" --test 0 --seed 7
  "$build/bindings/cli/focal" train --rigs "$work/$2"/*.rig.glb -o "$out/$1.focal" --threads "$threads" --seed 7
  rm -r "${work:?}/$2"
}

for name in $(echo "$only" | tr , ' '); do
  case $name in
    humanoid) make_model humanoid game_humanoid 60 ;;
    quadruped) make_model quadruped game_quadruped 40 ;;
    hand) make_model hand hand 16 ;;
    *) echo "there is no stock model '$name': humanoid, quadruped, hand" >&2; exit 2 ;;
  esac
done
FOCAL_MODELS=$out "$build/bindings/cli/focal" models
