#!/bin/sh
# Fuzzes every target for so many seconds, two at a time, in a build with clang and sanitizers; what was found is kept in
# BUILD/tests/fuzz/found and is where the next run starts. Ends with a line a target: executions, inputs kept, crashes.
# usage: run.sh [SECONDS] [BUILD] [TARGET...]        (60, build/asan, all)
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-60} build=${2:-build/asan}
[ $# -gt 2 ] && shift 2 || set -- gltf model landmarks calls
source=$PWD/tests/fuzz
fuzz_one() {
  folder=$build/tests/fuzz
  mkdir -p "$folder/found/$1" "$folder/crashes"
  "$folder/focal_fuzz_$1" -max_total_time="$seconds" -max_len=16384 -timeout=120 -rss_limit_mb=4096 -print_final_stats=1 \
    -artifact_prefix="$folder/crashes/$1-" "$folder/found/$1" "$source/seeds/$1" > "$folder/$1.log" 2>&1 || true
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$folder/$1.log")
  crashes=$(find "$folder/crashes" -name "$1-*" | wc -l)
  echo "$1: ${executions:-0} executions, $(find "$folder/found/$1" -type f | wc -l) inputs kept, $crashes crashes" | tee "$folder/$1.result"
  [ -n "$executions" ] && [ "$crashes" -eq 0 ] || tail -n 40 "$folder/$1.log"
}
while [ $# -gt 0 ]; do
  fuzz_one "$1" &
  if [ $# -gt 1 ]; then fuzz_one "$2" & shift; fi
  shift
  wait
done
! grep -qE ': 0 executions|[1-9][0-9]* crashes' "$build"/tests/fuzz/*.result
