#!/bin/sh
# The shared library exports exactly the functions of focal.h, and needs the C library alone.
# usage: exports.sh LIBRARY HEADER
set -eu
library=$1 header=$2
exported=$(nm -D --defined-only "$library" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | sort)
declared=$(tr '\n' ' ' <"$header" | grep -o 'FOCAL_API [^;]*;' | grep -o 'focal_[a-z0-9_]*(' | tr -d '(' | sort)
if [ "$exported" != "$declared" ]; then
  echo "exported, but not in focal.h:"
  printf '%s\n' "$exported" | while read -r name; do printf '%s\n' "$declared" | grep -qx "$name" || echo "  $name"; done
  echo "in focal.h, but not exported:"
  printf '%s\n' "$declared" | while read -r name; do printf '%s\n' "$exported" | grep -qx "$name" || echo "  $name"; done
  exit 1
fi
needed=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' |
  grep -Ev '^(libc\.so|libm\.so|ld-linux)' || true)
if [ -n "$needed" ] && ! echo "$needed" | grep -q 'lib.san\.so'; then
  echo "the library needs more than libc and libm:" $needed
  exit 1
fi
newest=$(objdump -T "$library" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -1)
if [ -z "$needed" ] && [ "$(printf '%s\n' "$newest" GLIBC_2.36 | sort -V | tail -1)" != GLIBC_2.36 ]; then
  echo "the library needs $newest, Debian 12 has GLIBC_2.36"
  exit 1
fi
echo "$(printf '%s\n' "$exported" | wc -l) functions, as declared; newest symbol $newest"
