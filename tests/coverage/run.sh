#!/bin/sh
# Line and branch coverage of what reads foreign bytes and of the C interface, by gcov, in a build of its own
# (build/coverage). usage: run.sh [LEAST]      fails when fewer than LEAST percent of the branches are taken (90)
set -eu
cd "$(dirname "$0")/../.."
cmake --preset release -B build/coverage -DFOCAL_COVERAGE=ON -DFOCAL_BUILD_PYTHON=OFF --log-level=NOTICE \
  ${CMAKE_CXX_COMPILER_LAUNCHER:+-DCMAKE_CXX_COMPILER_LAUNCHER=$CMAKE_CXX_COMPILER_LAUNCHER} > /dev/null
cmake --build build/coverage
find build/coverage -name '*.gcda' -delete
ctest --test-dir build/coverage --parallel "$(nproc)" --output-on-failure \
  -R '^(base|gltf|landmarks/.*_file|capi|cli|faults|fuzz|samples)' > build/coverage/tests.log || { cat build/coverage/tests.log; exit 1; }
python3 tests/coverage/report.py build/coverage "${1:-90}"
