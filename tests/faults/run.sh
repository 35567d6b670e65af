#!/bin/sh
# All that docs/reliability.md counts on memory, files, settings and threads that fail or are odd. Some hours, most of them for the paper's training.
# usage: run.sh [BUILD], default build/release; a build of the preset tsan runs what a thread sanitizer can
set -eu
build=$(cd "${1:-$(dirname "$0")/../../build/release}" && pwd)
programs=$build/tests/faults
failed=0
run() {
  echo "== $*"
  "$@" || failed=1
}

# A locale with a decimal comma, where none is installed.
if ! locale -a | grep -qi '^de_DE'; then
  LOCPATH=$(mktemp -d)
  export LOCPATH
  trap 'rm -rf "$LOCPATH"' EXIT
  localedef -i de_DE -f UTF-8 "$LOCPATH/de_DE.UTF-8" || true
fi
run "$programs/focal_same_bits" 7
[ -x "$programs/focal_out_of_memory" ] || exit "$failed"  # a build with sanitizers
run "$programs/focal_same_bits" 30
run "$programs/focal_memory_budget" --steps 40
run "$programs/focal_memory_budget" --steps 10 --rings 30 --threads 4
run "$programs/focal_files" 200
run "$programs/focal_cycles" "$build/capi/libfocal.so" 1000 100
run "$programs/focal_out_of_memory" --most 50 --threads 4
run "$programs/focal_out_of_memory"
exit "$failed"
