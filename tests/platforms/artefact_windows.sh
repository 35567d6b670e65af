#!/bin/sh
# The DLL exports exactly the functions of focal.h; it and the command need KERNEL32 and the C runtime alone, and each other.
# usage: artefact_windows.sh FOCAL_DLL FOCAL_EXE HEADER
set -eu
dll=$1 command=$2 header=$3
objdump=x86_64-w64-mingw32-objdump
exported=$($objdump -p "$dll" | sed -n 's/^[[:space:]]*\[ *[0-9]*\] \(+base\[ *[0-9]*\] *[0-9a-f]* \)\{0,1\}\([A-Za-z_][A-Za-z0-9_]*\)$/\2/p' | sort)
declared=$(tr '\n' ' ' < "$header" | grep -o 'FOCAL_API [^;]*;' | grep -o 'focal_[a-z0-9_]*(' | tr -d '(' | sort)
if [ "$exported" != "$declared" ]; then
  echo "the DLL does not export what focal.h declares:"
  printf '%s\n' "$exported" > "$dll.exported"
  printf '%s\n' "$declared" | diff "$dll.exported" - || true
  exit 1
fi
for file in "$dll" "$command"; do
  needed=$($objdump -p "$file" | sed -n 's/.*DLL Name: //p' |
    grep -Eiv '^(kernel32|msvcrt|ucrtbase|api-ms-win-crt-.*|focal)\.dll$' || true)
  [ -z "$needed" ] || { echo "$file needs more than KERNEL32 and the C runtime:" $needed; exit 1; }
done
x86_64-w64-mingw32-strip -o "$dll.stripped" "$dll"
size=$(wc -c < "$dll.stripped")
rm "$dll.stripped"
echo "$(printf '%s\n' "$exported" | wc -l) functions, as declared; needs KERNEL32 and the C runtime; $size bytes without symbols"
