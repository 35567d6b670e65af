#!/bin/sh
# Installs the Debian (12) or Ubuntu (24.04) packages that are missing, and only those; says what it does.
# usage: bootstrap.sh [ci]      what building and testing needs; with ci also what .ci/run needs
set -eu
packages="g++ cmake ninja-build pkgconf libeigen3-dev libspectra-dev libtinygltf-dev nlohmann-json3-dev
  libcli11-dev doctest-dev"
optional=  # tests that need them are skipped without
if [ "${1:-}" = ci ]; then
  packages="$packages abigail-tools chromium clang clang-format-14 libclang-rt-dev valgrind"
  optional="blender debootstrap python3-matplotlib python3-numpy xvfb"
  command -v node > /dev/null || optional="$optional nodejs npm"
fi

if ! command -v dpkg-query > /dev/null; then
  # shellcheck disable=SC2086  # the packages are words
  echo "bootstrap: this is no Debian or Ubuntu; install what these packages hold yourself:" $packages >&2
  exit 1
fi

missing_of() {  # PACKAGE...
  for package; do
    dpkg-query -W -f '${db:Status-Status}\n' "$package" 2> /dev/null | grep -qx installed || printf ' %s' "$package"
  done
}

install_packages() {  # PACKAGE...
  as_root=
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo > /dev/null; then
      echo "bootstrap: packages are missing and there is no sudo; as root run: apt-get install $*" >&2
      return 1
    fi
    as_root=sudo
  fi
  echo "bootstrap: installing $*"
  $as_root apt-get -qq update &&
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "$@" > /dev/null
}

# shellcheck disable=SC2046,SC2086  # the packages are words
{
  set -- "${1:-}" $(missing_of $packages)
  mode=$1
  shift
  [ $# -eq 0 ] || install_packages "$@" || exit 1
  set -- $(missing_of $optional)
  [ $# -eq 0 ] || install_packages "$@" || echo "bootstrap: could not install $*; tests that need them are skipped"
}
echo "bootstrap: all packages needed are installed"

# The sources of meshoptimizer, which cmake/FocalMeshoptimizer.cmake compiles in, from the mirror that apt uses: its source package lies
# beside the binary one. Where the mirror has another version, CMake downloads them from Debian's.
fetch_meshoptimizer() {
  kept=$(dirname "$0")/../build/third_party archive=meshoptimizer_0.18+dfsg.orig.tar.xz
  sum=881ea2cc687f1fef5ce70484e0ca6504e13856dd856677749f3763bc685956d3
  [ -f "$kept/$archive" ] && echo "$sum  $kept/$archive" | sha256sum --check --quiet - 2> /dev/null && return
  mkdir -p "$kept"
  mirror=$(apt-get download --print-uris libmeshoptimizer-dev 2> /dev/null | sed "s#^'\(.*\)/[^/]*' .*#\1#")
  echo "bootstrap: fetching the sources of meshoptimizer into build/third_party"
  /usr/lib/apt/apt-helper download-file "$mirror/$archive" "$kept/$archive" "SHA256:$sum" > /dev/null 2>&1 || {
    rm -f "$kept/$archive" "$kept/$archive.FAILED"
    echo "bootstrap: '$mirror' has no $archive, so CMake will download it"
  }
}
fetch_meshoptimizer

# What tests/viewers judges files with; without it that test is skipped.
install_viewers() {
  tools=$(dirname "$0")/../build/tools wanted=$(dirname "$0")/../tests/viewers/package.json
  [ -d "$tools/node_modules/three" ] && cmp -s "$wanted" "$tools/package.json" && return
  mkdir -p "$tools"
  cp "$wanted" "$tools/package.json"
  echo "bootstrap: fetching the packages of tests/viewers/package.json through npm into build/tools"
  npm install --prefix "$tools" --ignore-scripts --no-package-lock --no-audit --no-fund --loglevel=error \
    --fetch-retries=1 --fetch-timeout=20000 > "$tools/npm.log" 2>&1 ||
    echo "bootstrap: npm could not fetch them (see build/tools/npm.log); tests/viewers will be skipped"
}
if [ "$mode" = ci ] && command -v npm > /dev/null; then install_viewers; fi
