#!/bin/sh
# Installs the Debian (12) or Ubuntu (24.04) packages that are missing, and only those; says what it does.
# usage: bootstrap.sh [ci]      what building and testing needs; with ci also what .ci/run needs
set -eu
packages="g++ cmake ninja-build pkgconf libeigen3-dev libspectra-dev libtinygltf-dev nlohmann-json3-dev
  libmeshoptimizer-dev libcli11-dev doctest-dev"
[ "${1:-}" = ci ] && packages="$packages abigail-tools chromium clang-format-14 valgrind"

if ! command -v dpkg-query > /dev/null; then
  # shellcheck disable=SC2086  # the packages are words
  echo "bootstrap: this is no Debian or Ubuntu; install what these packages hold yourself:" $packages >&2
  exit 1
fi
missing=
for package in $packages; do
  dpkg-query -W -f '${db:Status-Status}\n' "$package" 2> /dev/null | grep -qx installed || missing="$missing $package"
done
if [ -z "$missing" ]; then
  echo "bootstrap: all packages needed are installed"
  exit 0
fi

as_root=
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "bootstrap: packages are missing and there is no sudo; as root run: apt-get install$missing" >&2
    exit 1
  fi
  as_root=sudo
fi
echo "bootstrap: installing$missing"
# shellcheck disable=SC2086  # the packages are words
{
  $as_root apt-get -qq update
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends $missing > /dev/null
}
