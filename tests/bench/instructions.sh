#!/bin/sh
# Counts the instructions of each stage on a small character under callgrind and fails when one took more than a tenth
# more than instructions.txt says. Counts do not depend on the machine's speed or load, so this can guard every change.
# usage: instructions.sh FOCAL_BENCH_COUNT [--update] [STAGE...]      --update writes instructions.txt anew
set -eu
known=$(cd "$(dirname "$0")" && pwd)/instructions.txt
program=$1
shift
update=
if [ "${1:-}" = --update ]; then update=yes && shift; fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Neither the C library's choices by processor (memcpy, exp) nor where memory lies may change a count.
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX512F,-AVX512VL,-ERMS,-FSRM
fixed_addresses=
setarch -R true 2> /dev/null && fixed_addresses="setarch -R"  # some containers forbid it
$fixed_addresses valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file="$folder/out" "$program" "$@" \
  > "$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }

# Each dump tells its stage ("desc: Trigger: Client Request: NAME") and its sum ("summary: COUNT" or "totals: COUNT").
for dump in "$folder"/out.*; do
  [ -e "$dump" ] || continue
  awk '/^desc: Trigger: Client Request:/ { name = $NF } /^(summary|totals):/ { count = $2 }
       END { if (name != "") print name, count }' "$dump"
done > "$folder/counts"
[ -s "$folder/counts" ] || { echo "no stage was counted: $*"; cat "$folder/log"; exit 1; }

if [ -n "$update" ]; then
  [ $# -eq 0 ] || { echo "--update takes all stages at once"; exit 2; }
  sort "$folder/counts" > "$known"
  echo "$known holds $(wc -l < "$known") counts"
  exit 0
fi

awk -v known="$known" '
  BEGIN { while ((getline line < known) > 0) { split(line, part, " "); before[part[1]] = part[2] } }
  {
    if (!($1 in before)) { printf "%-16s %14.0f  is not in instructions.txt: run with --update\n", $1, $2; bad = 1; next }
    change = 100 * ($2 / before[$1] - 1)
    verdict = change > 10 ? "  TOO MANY" : change < -10 ? "  fewer: run with --update to keep it so" : ""
    printf "%-16s %14.0f  %+6.1f %%%s\n", $1, $2, change, verdict
    if (change > 10) bad = 1
  }
  END { exit bad }' "$folder/counts"
