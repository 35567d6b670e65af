#!/bin/sh
# Errors on the evaluation sets (test split, mean edge lengths): trains and evaluates every set for some seeds and
# prints a line a set. Not a test with bounds: the figures go into docs/accuracy.md.
#   tests/accuracy/run.sh [--preset paper] [--seeds "0 1 2"] [--sets "scape faust5k"] [--subset "a,b,c"] [--build DIR]
#                         [--quality interactive] [--on SET: test on another set's meshes]
set -eu
cd "$(dirname "$0")/../.."
preset=default seeds="0 1 2" subset="" build=build/release out=build/accuracy quality=best on=""
sets="scape faust5k faust12k human07 teddy ant hand lion tosca_cat tosca_dog tosca_michael makehuman"
while [ $# -gt 0 ]; do
  case $1 in
    --preset) preset=$2 ;;
    --seeds) seeds=$2 ;;
    --sets) sets=$2 ;;
    --subset) subset=$2 ;;
    --build) build=$2 ;;
    --quality) quality=$2 ;;
    --on) on=$2 ;;
    *) echo "unknown option $1" >&2; exit 2 ;;
  esac
  shift 2
done
data=${FOCAL_EVALUATION_DATA:?set it to the folder of the evaluation sets}
focal=$build/bindings/cli/focal
mkdir -p "$out"

value() { sed -n "s/^ \"$1\": \([^,]*\),\{0,1\}\$/\1/p" "$2"; }  # a top-level key of a report

printf '%-14s %-8s %5s %9s %9s %9s %9s %7s %8s %9s %8s\n' set preset seeds mean median p95 over10 flipped meshes s/mesh train_s
for set in $sets; do
  for seed in $seeds; do
    name=$set.$preset.$seed
    began=$(date +%s)
    if [ ! -f "$out/$name.focal" ]; then
      "$focal" train "$data/$set" -o "$out/$name.focal" --preset "$preset" --seed "$seed" --quiet
      echo $(($(date +%s) - began)) > "$out/$name.train"
    fi
    report=$out/$name.$quality${on:+.$on}.json
    "$focal" eval "$out/$name.focal" "$data/${on:-$set}" --seed "$seed" --quality "$quality" --quiet --json \
      ${subset:+--subset "$subset"} > "$report"
    echo "$(value mean_edges "$report") $(value median_edges "$report") $(value p95_edges "$report") \
      $(value over_10_edges "$report") $(value flipped_meshes "$report") $(grep -c '"errors_edges"' "$report") \
      $(value seconds_median "$report") $(cat "$out/$name.train")"
  done | awk -v set="$set${on:+ on $on}" -v preset="$preset" '
    { mean += $1; median += $2; p95 += $3; over += $4; flips = $5 == "null" ? "-" : flips + $5; meshes += $6; s += $7; train += $8 }
    END { printf "%-14s %-8s %5d %9.3f %9.3f %9.3f %9.4f %7s %8d %9.2f %8.1f\n", set, preset, NR, mean / NR, median / NR,
          p95 / NR, over / NR, flips, meshes, s / NR, train / NR }'
done
