#!/bin/sh
# The skeletons of some characters are learned and put on another one, which then plays the animation of the first: a strip of
# pictures, the source above, the target below.
# usage: rig_strip.sh OUT.svg TARGET.glb ANIMATION "SECONDS SECONDS ..." SOURCE.glb [CHARACTER.glb ...]
# Without arguments: sample quadrupeds, into build/rig_strip.svg. After samples/demo.sh, or with the tree built.
set -eu
bin=$(cd "$(dirname "$0")/.." && pwd)/build/release
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

if [ $# -eq 0 ]; then
  "$bin"/samples/creatures/focal_creatures "$scratch/set" --family quadruped --train 8 --test 1 > "$scratch/log"
  made=$scratch/set/quadruped/quadruped
  set -- "$bin/../rig_strip.svg" "${made}_08.glb" stretch "0 0.25 0.5 0.75 1" "$made"_0[0-7].rig.glb
fi
[ $# -ge 5 ] || { sed -n '2,5s/^# //p' "$0" >&2; exit 2; }
picture=$1 target=$2 animation=$3 seconds=$4
shift 4

"$bin"/bindings/cli/focal train -o "$scratch/model.focal" --rigs "$@"
"$bin"/bindings/cli/focal rig "$scratch/model.focal" "$target" --animations "$1" -o "$scratch/rigged.glb"
given=$animation  # one that the target had under this name keeps it
if grep -aqF "\"$animation (2)\"" "$scratch/rigged.glb"; then given="$animation (2)"; fi
frames() { for frame in $seconds; do echo "$1,,$frame s,10,-60,$2,$frame"; done; }
{ frames "$1" "$animation"; frames "$scratch/rigged.glb" "$given"; } | tr '\n' '\0' |
  xargs -0 "$bin"/samples/picture/focal_picture --columns "$(echo "$seconds" | wc -w)" "$picture"
echo "$picture"
