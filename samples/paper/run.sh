#!/bin/sh
# Reproduces the tables and figures of Xia et al. 2016 in build/paper/index.html, presets paper and default side by side: on the
# sample characters, and on real meshes where FOCAL_EVALUATION_DATA (or ../shared/data) has them.
# usage: run.sh [--quick] [SET...]      sets of your own instead; --quick: sample characters and few shapes, two minutes instead of twenty
# It needs a python3 with NumPy and matplotlib; FOCAL_PYTHON names another interpreter than python3.
set -eu
cd "$(dirname "$0")/../.."
bin=build/release
out=build/paper
data=${FOCAL_EVALUATION_DATA:-../shared/data}
quick=
[ "${1:-}" != --quick ] || { quick=--quick; shift; }

python=
for candidate in ${FOCAL_PYTHON:-python3 /usr/bin/python3}; do
  if "$candidate" -c 'import matplotlib, numpy' 2> /dev/null; then python=$candidate; break; fi
done
[ -n "$python" ] || { echo "no python3 with NumPy and matplotlib; on Debian: apt-get install python3-numpy python3-matplotlib" >&2; exit 1; }

cmake --preset release --log-level=NOTICE > /dev/null
cmake --build --preset release --target focal_creatures focal_python_package
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
# shellcheck disable=SC2086  # no option is no word
PYTHONPATH=$bin/bindings/python PYTHONDONTWRITEBYTECODE=1 "$python" samples/paper/main.py $quick "$out/index.html" "$@"
echo "Look at $out/index.html"
