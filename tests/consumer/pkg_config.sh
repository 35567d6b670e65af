#!/bin/sh
# The consumer once more, found by pkg-config. usage: pkg_config.sh PREFIX CC OUT
set -eu
PKG_CONFIG_PATH=$(dirname "$(find "$1" -name focal.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046  # the flags are words
"$2" -std=c99 "$(dirname "$0")/main.c" -o "$3" $(pkg-config --cflags --libs focal)
LD_LIBRARY_PATH=$(pkg-config --variable=libdir focal) "$3"
