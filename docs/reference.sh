#!/bin/sh
# Makes the reference of the C interface from its header with Doxygen (a Debian package): build/reference/html/index.html.
set -eu
cd "$(dirname "$0")/.."
command -v doxygen > /dev/null || { echo "reference.sh: doxygen is missing: apt-get install doxygen" >&2; exit 1; }
mkdir -p build/reference
# The header's plain comments stand before what they describe, or behind it on its line; a comment before several
# declarations without a blank line between them is for all of them; "---- Mesh ----" begins a chapter.
awk '
BEGIN { RS = ""; ORS = "\n\n" }
{
  declarations = gsub(/FOCAL_API focal_|FOCAL_API const|FOCAL_API int|FOCAL_API uint|FOCAL_API double/, "&")
  if ($0 ~ /^\/\* ---- .* ---- \*\/$/) {
    title = $0; gsub(/^\/\* ---- | ---- \*\/$/, "", title)
    print (chapters++ ? "/** @} */\n" : "") "/** @defgroup chapter" chapters " " title " */\n/** @addtogroup chapter" chapters "\n@{ */"
    next
  }
  if (NR == 1) { sub(/^\/\* focal\.h - [^\n]*\n/, "/** @mainpage focal.h\n@verbatim\n"); sub(/\*\//, "@endverbatim */") }
  gsub(/[;,{] *\/\* /, "&\001"); gsub(/\/\* \001/, "/**< ")    # behind a field
  gsub(/\n *\/\* /, "&\001"); gsub(/\/\* \001/, "/** ")
  sub(/^\/\* /, "/** ")
  if (declarations > 1 && $0 ~ /^\/\*\*/) { sub(/\*\/\n/, "*/\n/** @{ */\n"); $0 = $0 "\n/** @} */" }
  if ($0 ~ /^#ifdef __cplusplus\n}/ && chapters) $0 = "/** @} */\n" $0
  print
}' include/focal/focal.h > build/reference/focal.h
doxygen - > build/reference/log.txt << END
PROJECT_NAME = focal
PROJECT_BRIEF = "Few-shot landmarks on triangle meshes: the C interface"
INPUT = build/reference/focal.h
OUTPUT_DIRECTORY = build/reference
GENERATE_LATEX = NO
OPTIMIZE_OUTPUT_FOR_C = YES
EXTRACT_ALL = YES
DISTRIBUTE_GROUP_DOC = YES
JAVADOC_AUTOBRIEF = YES
TYPEDEF_HIDES_STRUCT = YES
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = FOCAL_API= FOCAL_H_
WARN_LOGFILE = build/reference/warnings.txt
QUIET = YES
HAVE_DOT = NO
END
echo "build/reference/html/index.html ($(grep -c warning build/reference/warnings.txt || true) warnings)"
