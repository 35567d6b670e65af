#!/bin/sh
# Line and branch coverage of what reads foreign bytes and of the C interface by their own tests, by clang and llvm-cov (package
# llvm), in a build of its own (build/coverage). usage: run.sh [LEAST] [--missing]
# Fails when fewer than LEAST percent (90) of the branches of one of the folders are taken; --missing lists the others.
set -eu
cd "$(dirname "$0")/../.."
build=build/coverage
cmake --preset release -B $build -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" \
  -DFOCAL_COVERAGE=ON -DFOCAL_BUILD_PYTHON=OFF --log-level=NOTICE \
  ${CMAKE_CXX_COMPILER_LAUNCHER:+-DCMAKE_CXX_COMPILER_LAUNCHER=$CMAKE_CXX_COMPILER_LAUNCHER} > /dev/null
cmake --build $build --parallel "${JOBS:-$(nproc)}" --target focal_tests tests/capi/all samples/all focal_creatures
rm -rf $build/profiles
LLVM_PROFILE_FILE=$PWD/$build/profiles/%8m.profraw ctest --test-dir $build --parallel "${JOBS:-$(nproc)}" --output-on-failure \
  -R '^(base|gltf|(model|analysis)/.*_file|capi|samples/(characters|rig))' -E 'capi/(header|exports)' > $build/tests.log ||
  { cat $build/tests.log; exit 1; }
llvm-profdata merge -sparse -o $build/tests.profdata $build/profiles/*.profraw
llvm-cov export -format=text -instr-profile=$build/tests.profdata $build/tests/focal_tests -object $build/capi/libfocal.so \
  > $build/coverage.json
python3 tests/coverage/report.py $build/coverage.json "$@"
