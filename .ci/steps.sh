# shellcheck shell=sh
# Sourced: runs named steps and tells at the end where the time went.
steps_began=$(date +%s.%N)
steps_times=

step() {  # NAME COMMAND...
  steps_name=$1
  shift
  printf '== %s\n' "$steps_name"
  steps_start=$(date +%s.%N)
  "$@"
  steps_times="$steps_times$(steps_line "$steps_start" "$steps_name")
"
}

steps_line() { awk -v a="$1" -v b="$(date +%s.%N)" -v n="$2" 'BEGIN { printf "%8.1f s  %s", b - a, n }'; }

print_times() {
  printf '\nWhere the time went:\n%s%s\n\n' "$steps_times" "$(steps_line "$steps_began" "in all")"
}
