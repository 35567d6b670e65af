#!/bin/sh
# The table of errors on spoiled meshes: noise, holes, resolution, similarities, missing limbs; and of regions.
# Not a test with bounds: the figures go into docs/accuracy.md. Arguments go to the program.
#   tests/robustness/run.sh [--limit 8] [--seed 1] [--json FILE] [--split validation] [--cases "holes,arm"]
# To choose between ways of doing something, use --split validation: the test split is for reporting.
set -eu
cd "$(dirname "$0")/../.."
build=${FOCAL_BUILD:-build/release}
cmake --build "$build" --target focal_robustness >&2
exec "$build/tests/robustness/focal_robustness" "$@"
