#!/bin/sh
# Reads every #include of the product and fails on an arrow that the architecture does not allow (see CONTRIBUTING.md).
# usage: check.sh [ROOT]
set -eu
cd "${1:-$(dirname "$0")/../..}"

folders=
for folder in src include capi cuda bindings samples; do
  [ -d "$folder" ] && folders="$folders $folder"
done

# shellcheck disable=SC2086  # the folders are words
find $folders -type f \( -name '*.h' -o -name '*.hpp' -o -name '*.c' -o -name '*.cpp' -o -name '*.cu' \) | sort |
awk '
# A room may use what it stands on, and what that stands on in turn: "spectrum: operators" brings mesh along.
function allow(room, below,   names, n, i, name) {
  n = split(below " base", names, " ")
  allowed[room, room] = 1
  for (i = 1; i <= n; i++) {
    allowed[room, names[i]] = 1
    for (name in rooms) if ((names[i], name) in allowed) allowed[room, name] = 1
  }
  rooms[room] = 1
}
BEGIN {
  allow("base", "")
  allow("mesh", "")
  allow("compute", "")
  allow("gltf", "mesh")
  allow("operators", "mesh")
  allow("linear", "mesh")
  allow("spectrum", "operators linear")
  allow("geodesics", "operators linear")
  allow("augmentation", "mesh")
  allow("descriptors", "spectrum compute")
  allow("forest", "compute")
  allow("vote", "compute")
  allow("constellation", "geodesics")
  allow("model", "descriptors forest constellation")
  allow("analysis", "model vote")
  allow("paper", "analysis")
  allow("landmarks", "analysis paper augmentation")
  allow("correspondence", "landmarks")
  allow("skeleton", "landmarks gltf")
  rooms["include"] = 1; allowed["include", "include"] = 1
  allow("capi", "correspondence skeleton include")
  rooms["bindings"] = rooms["samples"] = rooms["cuda"] = 1
  allowed["bindings", "bindings"] = allowed["bindings", "include"] = 1
  allowed["samples", "samples"] = allowed["samples", "include"] = 1
  allowed["cuda", "cuda"] = 1  # and of compute what a module is made of, below
}
function fail(why) { print file ":" line ": " why; failures++ }
function check(target,   parts, to) {
  if (target ~ /(^|\/)\.\.?\//) { fail("\"" target "\": write includes from the root of src, not by ./ or ../"); return }
  if (target ~ /^tiny_gltf/ && file != "src/gltf/view.h") fail("tinygltf is seen by src/gltf/view.h only")
  if (target == "gltf/view.h" && room != "gltf") fail("the typed view of a document is seen by src/gltf only")
  if (target ~ /^(unsupported\/)?Eigen\// && file ~ /^(src|capi|include)\/.*\.(h|hpp)$/ && file != "src/base/matrix.h")
    fail("Eigen comes into headers through base/matrix.h only")
  to = room  # "x.h": a file beside this one
  if (split(target, parts, "/") > 1) to = parts[1] == "focal" ? "include" : parts[1]
  if (!(to in rooms) || (room, to) in allowed) return
  if (room == "cuda" && target ~ /^compute\/backend\.h$/) return
  fail("no arrow leads from " room " to " to " (\"" target "\")")
}
{
  file = $0
  split(file, path, "/")
  room = path[1] == "src" ? path[2] : path[1]
  if (!(room in rooms)) { line = 1; fail("folder " room " is not a room of the architecture") }
  for (line = 1; (getline text < file) > 0; line++)
    if (match(text, /^[ \t]*#[ \t]*include[ \t]*["<][^">]+/)) {
      target = substr(text, RSTART, RLENGTH)
      sub(/^[^"<]*["<]/, "", target)
      check(target)
      includes++
    }
  close(file)
}
END {
  if (NR == 0) { print "no source files found"; exit 1 }
  if (failures) { print failures " wrong includes"; exit 1 }
  print NR " files, " includes " includes: all arrows allowed"
}'
