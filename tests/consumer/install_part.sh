#!/bin/sh
# What `cmake --install` does after a build of some targets, as samples/demo.sh makes it: programs that are missing are left out.
# usage: install_part.sh BUILD PREFIX
set -eu
build=$1 prefix=$2
rm -rf "$prefix"
mkdir -p "$prefix"
# The same steps, in a build without the GPU module and the command.
sed -e 's#/libfocal_cuda\.so#/absent/libfocal_cuda.so#; s#/bindings/cli/focal"#/bindings/cli/absent/focal"#' \
  "$build/cmake_install.cmake" > "$prefix/steps.cmake"
grep -q absent "$prefix/steps.cmake" || { echo "nothing is left out: this test proves nothing"; exit 1; }
cmake -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LOCAL_ONLY=1 -P "$prefix/steps.cmake" > /dev/null
[ -f "$prefix/include/focal/focal.h" ] && ls "$prefix"/lib*/libfocal.so > /dev/null 2>&1 || ls "$prefix"/lib/*/libfocal.so > /dev/null
[ ! -e "$prefix/bin/focal" ]
echo "installed without the command and the GPU module"
