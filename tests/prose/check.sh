#!/bin/sh
# Fails, with file:line, on words that public text avoids: in guides, and in comments and string literals of code. The words are the
# first column of the table in CONTRIBUTING.md, section Words, and stand nowhere else.
# usage: check.sh [ROOT]
set -eu
cd "${1:-$(dirname "$0")/../..}"

folders="include src capi bindings samples cuda"
guides="README.md CONTRIBUTING.md CHANGELOG.md THIRD_PARTY.md docs/*.md"

list() {
  for file in $guides; do
    [ ! -f "$file" ] || echo "$file"
  done
  for folder in $folders; do
    [ -d "$folder" ] || continue
    find "$folder" -type f \( -name '*.h' -o -name '*.hpp' -o -name '*.c' -o -name '*.cpp' -o -name '*.cu' -o -name '*.js' -o -name '*.css' \
      -o -name '*.py' -o -name '*.sh' -o -name '*.cmake' -o -name CMakeLists.txt -o -name '*.html' -o -name '*.toml' \)
  done | sort
}

list | awk '
# "spoil*" -> ([Ss]poil[a-z]*): the first letter may be a capital, the others not, so that None of "is None" is no match.
function pattern(words,   first) {
  first = substr(words, 1, 1)
  gsub(/\*/, "[a-z]*", words)
  return "[" toupper(first) first "]" substr(words, 2)
}
function read_words(   text, inside, cell, n, parts, i) {
  while ((getline text < "CONTRIBUTING.md") > 0) {
    if (text ~ /^## /) inside = text == "## Words"
    if (!inside || text !~ /^\| *`/) continue
    split(text, cell, "|")
    n = split(cell[2], parts, "`")
    for (i = 2; i <= n; i += 2) { all = all (all == "" ? "" : "|") pattern(parts[i]); words++ }
  }
  close("CONTRIBUTING.md")
  avoided = "(^|[^A-Za-z_])(" all ")($|[^A-Za-z_])"
}
# The comments and strings of a line; `open` holds the end mark of one that continues on the next line.
function prose(text, kind,   out, ends, opens, one, is_separator) {
  if (kind == "text") return text
  opens = kind == "py" ? "[#\"\047]" : "//|/\\*|[`\"\047]"
  while (text != "") {
    if (open == "") {
      if (!match(text, opens)) break
      one = substr(text, RSTART, RLENGTH)
      if (kind == "py" && substr(text, RSTART, 3) == one one one) one = one one one
      is_separator = kind == "c" && one == "\047" && substr(text, RSTART - 1, 1) ~ /[0-9]/  # of the digits of a number
      text = substr(text, RSTART + length(one))
      if (is_separator) continue
      if (one == "#" || one == "//") { out = out " " text; break }
      open = one == "/*" ? "*/" : one
    }
    ends = position(text)
    if (ends == 0) {
      out = out " " text
      if (length(open) == 1) open = ""  # a string ends with its line
      break
    }
    out = out " " substr(text, 1, ends - 1)
    text = substr(text, ends + length(open))
    open = ""
  }
  return out
}
function position(text,   at, step) {  # of the end of what is open, past escaped quotes
  if (length(open) > 1) return index(text, open)
  at = 0
  while (match(text, "\\\\.|" open)) {
    if (RLENGTH == 1) return at + RSTART
    step = RSTART + RLENGTH - 1
    at += step
    text = substr(text, step + 1)
  }
  return 0
}
function report(text,   hit) {
  while (match(text, avoided)) {
    hit = substr(text, RSTART, RLENGTH)
    gsub(/^[^A-Za-z]+|[^A-Za-z]+$/, "", hit)
    print file ":" line ": \"" hit "\""
    failures++
    text = substr(text, RSTART + RLENGTH - 1)
  }
}
BEGIN { read_words(); if (!words) { print "CONTRIBUTING.md has no table of words"; failed = 1; exit 1 } }
{
  file = $0
  kind = file ~ /\.py$/ ? "py" : file ~ /\.(h|hpp|c|cpp|cu|js)$/ ? "c" : "text"
  open = last = ""
  skip = 0
  for (line = 1; (getline text < file) > 0; line++) {
    if (file == "CONTRIBUTING.md" && text ~ /^## /) skip = text == "## Words"
    if (skip) continue
    text = prose(text, kind)
    gsub(/^[ \t*\/#]+|[ \t]+$/, "", text)
    gsub(/[ \t]+/, " ", text)
    report(last " " text)  # with the last word of the line before: a line break may separate the words of a pattern
    lines++
    last = text
    sub(/.*[ \t]/, "", last)
    if (last ~ avoided) last = ""  # it was reported
  }
  close(file)
}
END {
  if (failed) exit 1
  if (NR == 0) { print "no text found"; exit 1 }
  if (failures) { print failures " words to avoid: CONTRIBUTING.md, section Words, says what to write instead"; exit 1 }
  print NR " files, " lines " lines: none of " words " words to avoid"
}'
