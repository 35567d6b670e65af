#!/bin/sh
# Installs what is missing, builds with warnings as errors and runs every test. Arguments go to ctest.
set -eu
cd "$(dirname "$0")/.."
.ci/bootstrap.sh
cmake --preset release -DFOCAL_WERROR=ON --log-level=NOTICE
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "$@"
