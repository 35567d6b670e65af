#!/bin/sh
# Fetches three.js through npm, as pinned by package-lock.json, and bundles it into OUT with surface_three.js.
# Without npm or network OUT becomes empty and a line says so, unless REQUIRED is ON: then it fails.
# usage: bundle.sh OUT FOLDER REQUIRED       FOLDER: where node_modules may lie
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$1 folder=$2 required=${3:-OFF}

bundle() {
  mkdir -p "$folder" &&
    cp "$here/package.json" "$here/package-lock.json" "$here/surface_three.js" "$folder/" && cd "$folder" || return 1
  npm ci --ignore-scripts --no-audit --no-fund --loglevel=error \
    --prefer-offline --fetch-retries=1 --fetch-timeout=20000 > npm.log 2>&1 || return 1
  # three.js keeps its licence notice in the bundle, which the page hands on.
  node_modules/.bin/esbuild surface_three.js --bundle --minify --format=iife --global-name=FocalThree \
    --target=es2020 --legal-comments=inline --charset=utf8 --log-level=error --outfile=bundle.js >> npm.log 2>&1
}

if (bundle); then
  cp "$folder/bundle.js" "$out"
  exit 0
fi
rm -rf "$folder/node_modules"
echo "bundle.sh: three.js could not be fetched through npm (see $folder/npm.log)" >&2
[ "$required" = ON ] && exit 1
echo "bundle.sh: report pages will draw with their own renderer instead" >&2
: > "$out"
