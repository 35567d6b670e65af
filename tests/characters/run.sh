#!/bin/sh
# How well does focal rig game characters? Prints a table and draws sheets of pictures of what was rigged.
# usage: tests/characters/run.sh [--quick] [--only A,B:kaykit,...] [--out FOLDER] [--build FOLDER] [--threads N]
#   --quick     12 teachers and 4 tests a family of the generator, of the data one pack: minutes; without it hours
#   --only      which experiments on the data, as wild_eval.py --only takes them
#   --out       where models, rigged files, tables and sheets go (build/characters)
#   --build     the build whose commands are used (build/release)
#   --threads   of focal (0: one a core)
# Characters of the generator (evaluate.py) always; those of the data with ../tools/wild/wild_eval.py, beside the folder that
# FOCAL_EVALUATION_DATA names (../shared/data), where it is. Sheets: generated.png, wild.png (sheet.py says how to read them).
# Fails when the generator's characters are rigged worse than their bounds. Needs a python3 with NumPy; FOCAL_PYTHON names one.
set -eu
called=$PWD
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
quick="" only="" out=build/characters build=build/release threads=0
while [ $# -gt 0 ]; do
  case $1 in
    --help|-h) sed -n '2,/^set /s/^# //p' "$here/run.sh"; exit 0 ;;
    --quick) quick=1; shift; continue ;;
    --only|--out|--build|--threads) [ $# -gt 1 ] || { echo "$1 needs a value" >&2; exit 2; } ;;
    *) echo "unknown option $1" >&2; exit 2 ;;
  esac
  case $1 in
    --only) only=$2 ;;
    --out) out=$2; case $out in /*) ;; *) out=$called/$out ;; esac ;;
    --build) build=$2; case $build in /*) ;; *) build=$called/$build ;; esac ;;
    --threads) threads=$2 ;;
  esac
  shift 2
done

python=
for candidate in ${FOCAL_PYTHON:-python3 /usr/bin/python3}; do
  if "$candidate" -c 'import numpy' 2> /dev/null; then python=$candidate; break; fi
done
[ -n "$python" ] || { echo "no python3 with NumPy (on Debian: python3-numpy)" >&2; exit 2; }
focal=$build/bindings/cli/focal
[ -x "$focal" ] || { echo "$focal is missing: cmake --preset release && cmake --build --preset release" >&2; exit 2; }
mkdir -p "$out"
export PYTHONDONTWRITEBYTECODE=1

status=0
"$python" "$here/evaluate.py" --focal "$focal" --creatures "$build/samples/creatures/focal_creatures" --out "$out/generated" \
  ${quick:+--teachers 12 --tests 4} -- --threads "$threads" > "$out/generated.txt" || status=$?
cat "$out/generated.txt"
if [ -f "$out/generated/results.json" ]; then
  "$python" "$here/sheet.py" "$out/generated.png" --results "$out/generated/results.json"
fi

data=${FOCAL_EVALUATION_DATA:-../shared/data}
wild=$data/../tools/wild/wild_eval.py
if [ ! -f "$data/wild/set.json" ] || [ ! -f "$wild" ]; then
  echo "skipped: characters of games: no $data/wild or no $wild"
  exit $status
fi
# wild_eval.py keeps its results: another build or other files start anew.
work=$out/wild
stamp=$(cksum "$focal" "$build"/capi/libfocal.so "$wild" "$data/wild/set.json" 2> /dev/null || :)
if [ -f "$work/stamp" ] && [ "$stamp" != "$(cat "$work/stamp")" ]; then rm -r "$work"; fi
mkdir -p "$work"
echo "$stamp" > "$work/stamp"
if [ -n "$quick" ]; then set -- --ks 3 --folds 2; only=${only:-B:kaykit}; else set -- --folds 3; fi
"$python" "$wild" --focal "$focal" --data "$data/wild" --makehuman "$data/makehuman" --split dev --threads "$threads" --keep-glb \
  --work "$work" --details "$work/details.json" "$@" ${only:+--only "$only"} > "$out/wild.txt" || status=$?
cat "$out/wild.txt"
"$python" "$here/sheet.py" "$out/wild.png" --wild "$work" --details "$work/details.json" || status=$?
exit $status
