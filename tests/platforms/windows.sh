#!/bin/sh
# Windows x64 on a Debian or Ubuntu machine: installs mingw-w64 and Wine where they are missing, builds the library, the command, the C
# samples and the tests for Windows, runs them under Wine and compares results with the Linux build's. Prints counts.
# usage: windows.sh          the build of Linux is build/release; that of Windows build/windows
set -eu
cd "$(dirname "$0")/../.."
build=$PWD/build/windows out=$PWD/build/windows/checks linux=$PWD/build/release
jobs=${JOBS:-$(nproc)}
unset FOCAL_EVALUATION_DATA  # real data is for Linux; the same code runs on the sample characters here

say() { printf '\n== %s\n' "$*"; }
fail() { echo "windows: $*" >&2; exit 1; }

install_tools() {
  command -v x86_64-w64-mingw32-g++-posix > /dev/null && command -v wine > /dev/null && return
  as_root=
  [ "$(id -u)" -eq 0 ] || as_root=sudo
  $as_root apt-get -qq update
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends g++-mingw-w64-x86-64-posix wine wine64 \
    > /dev/null
}

build_all() {
  cmake --preset release --log-level=NOTICE > /dev/null
  cmake --build --preset release --parallel "$jobs" --target focal_cli focal_creatures focal_tests > "$out/linux.log" 2>&1 ||
    { tail -n 30 "$out/linux.log"; return 1; }
  tests/platforms/stage_headers.sh build/headers
  cmake -S . -B "$build" -G Ninja --log-level=NOTICE -DCMAKE_TOOLCHAIN_FILE=cmake/toolchains/mingw-w64.cmake \
    -DCMAKE_PREFIX_PATH="$PWD/build/headers" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=6 \
    -DFOCAL_WERROR=ON -DFOCAL_CUDA=OFF -DFOCAL_BUILD_PYTHON=OFF -DFOCAL_REPORT_3D=OFF > /dev/null
  cmake --build "$build" --parallel "$jobs" > "$out/build.log" 2>&1 || { grep -E 'error|FAILED' "$out/build.log"; return 1; }
}

start_wine() {
  export WINEPREFIX="$build/wine" WINEDEBUG=-all WINEDLLOVERRIDES='mscoree=;mshtml=' LC_ALL=C.UTF-8
  export WINEPATH="Z:$build/capi"  # where focal.dll lies
  wineboot --init > /dev/null 2>&1
  wineserver --wait  # of the set-up; a server that runs cannot be made persistent
  wineserver --persistent  # kept between programs: each would start it again
  trap 'wineserver --kill' EXIT
  wine "$build/bindings/cli/focal.exe" --version
}

# Test cases of the core: those of Linux are the measure.
core_cases() {
  wine "$build/tests/focal_tests.exe" --no-colors > "$out/core.log" 2>&1 || { tail -n 60 "$out/core.log"; return 1; }
  here=$(sed -n 's/^\[doctest\] test cases: *\([0-9]*\) .*/\1/p' "$out/core.log")
  there=$("$linux/tests/focal_tests" --count | sed -n 's/.*filters: *\([0-9]*\).*/\1/p')
  grep '^\[doctest\] [ta]' "$out/core.log"
  echo "test cases of the core: $here under Wine, $there on Linux"
  [ $((10 * here)) -ge $((9 * there)) ]
}

# The C interface, samples, the GPU module's loading, fuzzed files (hostile ones), the command's parts.
other_tests() {
  ctest --test-dir "$build" --parallel "$jobs" --output-on-failure -R '^(capi|samples|compute|fuzz|cli)/' > "$out/ctest.log" 2>&1 ||
    { tail -n 60 "$out/ctest.log"; return 1; }
  grep 'tests passed' "$out/ctest.log"
}

focal() { wine "$build/bindings/cli/focal.exe" "$@"; }

# A Unix path as the program gets it.
names_and_paths() {
  name='狐 und Füchse, キャラクター'
  # No folder's name ends in a space, which Windows would drop.
  long=$out/names/$(printf '%.0sein langer Ordner und ' 1 2 3 4 5)so/$(printf '%.0snoch einer und ' 1 2 3 4 5 6 7 8 9)so/$name
  rm -rf "$out/names"
  mkdir -p "$long"
  [ ${#long} -ge 240 ] || fail "the long path has ${#long} characters only"
  cp "$out/characters/humanoid/humanoid_10.glb" "$long/$name.glb"
  cp "$out/model.focal" "$long/$name.focal"
  focal rig "Z:$long/$name.focal" "Z:$long/$name.glb" -o "Z:$long/$name out.glb" --quiet
  [ -s "$long/$name out.glb" ] || fail "no rig at a path of ${#long} characters and more"
  focal detect "Z:$long/$name.focal" "Z:$long/$name.glb" -o "Z:$long/$name.landmarks.json" --quiet
  grep -q "$name.glb" "$long/$name.landmarks.json" || fail "the landmark file does not name its mesh in UTF-8"
  cp "$long/$name.glb" "$out/names"  # no current folder is longer than 260 characters on Windows
  (cd "$out/names" && focal info "$name.glb" --json) | grep -q "$name" || fail "a relative path with spaces"
  (cd "$out" && focal info "$(echo "$out/characters/humanoid/humanoid_10.glb" | tr / '\\')" > /dev/null) || fail "backslashes"
  focal info "$out/characters/humanoid/humanoid_10.glb" > /dev/null || fail "a path that starts with a slash is taken for an option"
  mkdir -p "$out/names/models"
  cp "$out/model.focal" "$out/names/models/$name.focal"
  FOCAL_MODELS="Z:$out/names/models" focal models | grep -q "$name" || fail "a stock model with a name of other letters"
  [ -z "$(find "$out/names" -name '*.tmp')" ] || fail "temporary files were left"
  echo "paths of up to $((${#long} + ${#name} + 18)) characters, other letters, spaces, slashes and backslashes"
}

# Each ends with its own message, none with a crash.
refusals() {
  printf 'glTF' > "$out/broken.glb"
  printf '{"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"NUL"}],"meshes":[]}' > "$out/device.gltf"
  count=0
  for file in NUL CON COM1 '\\.\PhysicalDrive0' '\\?\C:\windows' "$out" "$out/nothing.glb" "$out/broken.glb" "$out/device.gltf" 'Q:\x.glb'; do
    status=0
    timeout 60 wine "$build/bindings/cli/focal.exe" info "$file" > "$out/refused" 2>&1 < /dev/null || status=$?
    [ $status -eq 1 ] && grep -q '^focal: ' "$out/refused" || { cat "$out/refused"; fail "'$file' ended with status $status"; }
    count=$((count + 1))
  done
  focal convert "$out/characters/humanoid/humanoid_10.landmarks.json" NUL > /dev/null 2>&1 || true  # a device may be written to
  echo "$count devices, folders and broken files refused"
}

same_results() {
  characters=$out/characters
  rm -rf "$characters" "$out/here" "$out/there" "$out/meshes"
  mkdir -p "$out/meshes"
  mkdir -p "$out/here/rigs" "$out/there/rigs" "$out/here/landmarks" "$out/there/landmarks"
  "$linux/samples/creatures/focal_creatures" "$characters" --family humanoid --train 10 --test 5 > /dev/null
  "$linux/samples/creatures/focal_creatures" "$characters" --family quadruped --train 10 --test 5 > /dev/null
  for family in humanoid quadruped; do
    "$linux/bindings/cli/focal" train "$characters/$family" -o "$out/there.$family.focal" --quiet
    focal train "$characters/$family" -o "$out/here.$family.focal" --quiet
  done
  for quality in interactive best; do
    for family in humanoid quadruped; do
      for number in 10 11 12 13 14; do
        mesh=$characters/$family/${family}_$number.glb result=landmarks/${family}_$number.landmarks.json
        "$linux/bindings/cli/focal" detect "$out/there.$family.focal" "$mesh" --quality $quality -o "$out/there/$result" --quiet
        focal detect "$out/here.$family.focal" "$mesh" --quality $quality -o "$out/here/$result" --quiet
        cp "$mesh" "$out/meshes"
      done
    done
    echo "$quality, each with its own model:"
    tolerance=0.01
    [ $quality = interactive ] || tolerance=0.1
    tests/platforms/compare.py "$out/there/landmarks" "$out/here/landmarks" "$out/meshes" --edges $tolerance
  done
  "$linux/bindings/cli/focal" train --rigs "$characters"/humanoid/humanoid_0[0-5].rig.glb -o "$out/model.focal" --quiet
  for number in 10 11; do
    mesh=$characters/humanoid/humanoid_$number.glb result=rigs/humanoid_$number.rigged.glb
    "$linux/bindings/cli/focal" rig "$out/model.focal" "$mesh" -o "$out/there/$result" --quiet
    focal rig "$out/model.focal" "$mesh" -o "$out/here/$result" --quiet
  done
  echo "rigs, of the same model:"
  tests/platforms/compare.py "$out/there/rigs" "$out/here/rigs" "$characters/humanoid"
}

mkdir -p "$out"
say "packages"
install_tools
.ci/bootstrap.sh
say "build"
build_all
say "artefacts"
tests/platforms/artefact_windows.sh "$build/capi/focal.dll" "$build/bindings/cli/focal.exe" include/focal/focal.h
say "Wine"
start_wine
say "unit tests of the core"
core_cases
say "C interface, samples, command, hostile files"
other_tests
say "results beside those of Linux"
same_results
say "names and paths"
names_and_paths
say "devices and broken files"
refusals
printf '\nwindows: all passed\n'
