#!/bin/sh
# The table of errors on spoiled meshes: noise, holes, resolution, similarities, missing limbs; and of regions.
# Not a test with bounds: the figures go into docs/accuracy.md. Arguments go to the program.
#   tests/robustness/run.sh [--limit 8] [--seed 1] [--json FILE] [--split validation] [--cases "holes,arm"]
# And bad meshes, see bad_meshes.cpp: run.sh bad-meshes [--count 5000] [--seed 1] [--kind "spikes"]
# To choose between ways of doing something, use --split validation: the test split is for reporting.
set -eu
cd "$(dirname "$0")/../.."
build=${FOCAL_BUILD:-build/release}
program=focal_robustness
if [ "${1:-}" = bad-meshes ]; then program=focal_bad_meshes && shift; fi
cmake --build "$build" --target $program >&2
exec "$build/tests/robustness/$program" "$@"
