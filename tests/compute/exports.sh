#!/bin/sh
# The module exports its entry alone, and the library knows nothing of CUDA.
# usage: exports.sh LIBRARY MODULE
set -eu
exported=$(nm -D --defined-only "$2" | awk '$2 != "A" { print $3 }')
if [ "$exported" != focal_compute_entry ]; then
  echo "the module exports more or less than its entry:" $exported
  exit 1
fi
if nm -D "$1" | grep -Ei ' (cu|cuda|cublas|cusolver)[A-Z]' || readelf -d "$1" | grep -i 'NEEDED.*cu'; then
  echo "the library needs something of CUDA"
  exit 1
fi
echo "one function exported; nothing of CUDA in the library"
