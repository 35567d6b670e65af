#!/bin/sh
# Proves that check.sh can fail: each wrong include below must be refused, each right one accepted.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

status() {  # FILE LINE -> what check.sh says of a tree holding just that
  rm -rf "${tree:?}"/*
  mkdir -p "$tree/$(dirname "$1")"
  printf '// a file\n%s\n' "$2" > "$tree/$1"
  "$here/check.sh" "$tree" > "$tree/out" 2>&1 && echo accepted || echo refused
}
wrong=0
expect() {  # accepted|refused FILE LINE
  got=$(status "$2" "$3")
  [ "$got" = "$1" ] && return
  echo "$2: $3 is $got, should be $1"
  wrong=$((wrong + 1))
}

expect accepted src/mesh/a.cpp '#include "base/error.h"'
expect accepted src/mesh/a.cpp '#include "mesh/a.h"'
expect accepted src/spectrum/a.cpp '#include "mesh/triangle_mesh.h"'
expect accepted src/landmarks/a.h '#include "vote/peaks.h"'
expect accepted src/operators/a.cpp '#include <Eigen/SparseCore>'
expect accepted src/base/matrix.h '#include <Eigen/Core>'
expect accepted src/gltf/view.h '#include <tiny_gltf.h>'
expect refused src/gltf/reader.cpp '#include <tiny_gltf.h>'
expect refused capi/a.cpp '#include "gltf/view.h"'
expect accepted capi/a.cpp '#include "gltf/document.h"'
expect accepted bindings/cli/a.cpp '#include <focal/focal.h>'
expect accepted samples/a.c '#include "focal/focal.h"'
expect accepted cuda/a.cu '#include "compute/backend.h"'

expect refused src/base/a.h '#include "mesh/triangle_mesh.h"'
expect refused src/mesh/a.cpp '  #  include "landmarks/train.h"'
expect refused src/landmarks/a.cpp '#include "gltf/document.h"'
expect refused src/vote/a.cpp '#include "forest/regression_forest.h"'
expect refused src/vote/a.cpp '#include "mesh/triangle_mesh.h"'
expect refused src/mesh/a.cpp '#include "../landmarks/train.h"'
expect refused src/mesh/a.cpp '#include "focal/focal.h"'
expect refused src/mesh/a.h '#include <Eigen/Dense>'
expect refused src/mesh/a.cpp '#include <tiny_gltf.h>'
expect refused src/attic/a.cpp '#include "base/error.h"'
expect refused bindings/cli/a.cpp '#include "landmarks/train.h"'
expect refused samples/a.c '#include "base/error.h"'
expect refused include/focal/focal.h '#include "capi/handles.h"'
expect refused cuda/a.cu '#include "compute/cpu_backend.h"'
expect refused src/compute/a.cpp '#include "cuda/kernels.h"'

[ "$wrong" -eq 0 ] && echo "the layer check catches what it must"
