#!/bin/sh
# Copies the header-only packages that a cross build needs into FOLDER, with what CMake finds them by: where they are installed,
# /usr/include, the C library's headers of this machine lie as well. usage: stage_headers.sh FOLDER
set -eu
folder=$1
rm -rf "$folder"
mkdir -p "$folder/include" "$folder/lib/cmake" "$folder/share/cmake"
cp -r /usr/include/eigen3 /usr/include/nlohmann /usr/include/CLI /usr/include/Spectra /usr/include/doctest \
  /usr/include/tiny_gltf.h "$folder/include"
cp -r /usr/share/eigen3 /usr/share/spectra "$folder/share"
cp -r /usr/share/cmake/nlohmann_json /usr/share/cmake/CLI11 "$folder/share/cmake"
cp -r /usr/lib/cmake/doctest "$folder/lib/cmake"
# Debian's own prefix is written into some of them.
folder=$(cd "$folder" && pwd)
find "$folder" -name '*.cmake' -exec sed -i "s#^set(_IMPORT_PREFIX \"/usr\")#set(_IMPORT_PREFIX \"$folder\")#" {} +
