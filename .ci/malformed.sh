#!/bin/sh
# Damaged glTF files against the command: each must be read or refused with a message and a hint, in time, and
# never crash. usage: malformed.sh FOCAL FOCAL_CREATURES       (builds with sanitizers)
set -eu
focal=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$2" "$folder/good" --family hand --train 1 --test 0 > /dev/null
good=$(find "$folder/good" -name '*.glb' | sort | head -n 1)
size=$(wc -c < "$good")
json=$(od -An -tu4 -j12 -N4 "$good" | tr -d ' ')

i=0
while [ $i -lt 40 ]; do  # cut short: within the headers and the JSON, then anywhere
  length=$((i < 20 ? i * (json + 28) / 20 : i * size / 40))
  head -c "$length" "$good" > "$folder/cut_$i.glb"
  i=$((i + 1))
done
i=0
while [ $i -lt 80 ]; do  # one byte changed: every byte of the headers, then all over the JSON
  at=$((i < 20 ? i : 20 + (i - 20) * json / 60))
  cp "$good" "$folder/changed_$i.glb"
  printf '\377' | dd of="$folder/changed_$i.glb" bs=1 seek="$at" conv=notrunc 2> /dev/null
  i=$((i + 1))
done
ls "$folder"/*.glb > "$folder/list"
if [ -d "${FOCAL_EVALUATION_DATA:-}/corpora/gltf_invalid" ]; then
  find "$FOCAL_EVALUATION_DATA/corpora/gltf_invalid" -name '*.gltf' -o -name '*.glb' >> "$folder/list"
fi

read_count=0 refused=0 bad=0
while read -r file; do
  status=0
  timeout 20 "$focal" info "$file" > "$folder/out" 2>&1 < /dev/null || status=$?
  if [ $status -eq 0 ]; then
    read_count=$((read_count + 1))
  elif [ $status -eq 1 ] && grep -q 'hint: ' "$folder/out" && ! grep -qE 'Sanitizer|runtime error' "$folder/out"; then
    refused=$((refused + 1))
  else
    bad=$((bad + 1))
    echo "$file: exit status $status"
    tail -n 20 "$folder/out"
  fi
done < "$folder/list"
echo "malformed files: $read_count read, $refused refused with a hint, $bad bad"
[ $bad -eq 0 ]
