#!/bin/sh
# Installs the Debian (12) or Ubuntu (24.04) packages that are missing, and only those; says what it does.
# usage: bootstrap.sh build|test|ci      test is build and more, ci is test and more
set -eu
kind=${1:-build}

packages="g++ cmake ninja-build libeigen3-dev libspectra-dev libtinygltf-dev nlohmann-json3-dev
  libmeshoptimizer-dev libcli11-dev"
case "$kind" in
  build) ;;
  test) packages="$packages doctest-dev pkgconf" ;;
  ci) packages="$packages doctest-dev pkgconf abigail-tools clang-format-14" ;;
  *) echo "usage: $0 build|test|ci" >&2; exit 2 ;;
esac

command -v dpkg-query > /dev/null || {
  echo "bootstrap: this is no Debian or Ubuntu; install what these packages hold yourself:" $packages >&2
  exit 1
}
missing=
for package in $packages; do
  dpkg-query -W -f '${db:Status-Status}\n' "$package" 2> /dev/null | grep -qx installed || missing="$missing $package"
done
[ -n "$missing" ] || { echo "bootstrap: every package needed is there"; exit 0; }

as_root=
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo > /dev/null || {
    echo "bootstrap: missing packages; as root run: apt-get install$missing" >&2
    exit 1
  }
  as_root="sudo"
fi
echo "bootstrap: installing$missing"
$as_root apt-get -qq update
# shellcheck disable=SC2086  # the packages are words
$as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends $missing
