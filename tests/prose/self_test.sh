#!/bin/sh
# Proves that check.sh can fail: each line below is planted alone in a tree, and must be refused or accepted.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
wrong=0

expect() {  # accepted|refused FILE TEXT: TEXT begins on line 2 of FILE, and the last of its lines is the one to be reported
  rm -rf "${tree:?}"/*
  cp "$here/../../CONTRIBUTING.md" "$tree"
  mkdir -p "$tree/$(dirname "$2")"
  printf '\n%s\n' "$3" >> "$tree/$2"
  last=$(wc -l < "$tree/$2" | tr -d ' ')
  if "$here/check.sh" "$tree" > "$tree/out" 2>&1; then got=accepted
  elif grep -q "^$2:$last: " "$tree/out"; then got=refused
  else got="refused without $2:$last"
  fi
  [ "$got" = "$1" ] && return
  echo "$2: $3: $got, should be $1"
  wrong=$((wrong + 1))
}

expect accepted README.md 'A plain sentence, as a reader expects it.'
expect refused README.md 'Nothing was told.'
expect refused README.md 'Told by nobody.'
expect refused docs/rigs.md 'how a reckoning ends'
expect refused docs/rigs.md 'there is
none'
expect accepted docs/rigs.md 'retold, and a stronghold'
expect accepted docs/unknown.txt 'told'

expect refused bindings/cli/a.cpp '// what it told'
expect refused bindings/cli/a.cpp 'int a = 1; /* of a spoiled mesh */'
expect refused bindings/cli/a.cpp '/* a mesh that a user
   has spoiled */'
expect refused bindings/cli/a.cpp 'print("it was \"told\" twice");'
expect refused bindings/cli/a.cpp "int a = 1'000'000; print(\"told\");"
expect accepted bindings/cli/a.cpp 'int told = spoiled + 1;  // a name is no prose'
expect accepted bindings/cli/a.cpp 'print("a"); told(/* b */ told); c = '\''"'\'' + told;'
expect accepted bindings/cli/a.cpp '/* a
   b */ int told;'
expect refused cuda/a.cu '// reckons'
expect refused samples/run.sh '# made anew'

expect refused bindings/python/focal/a.py '    """As told."""'
expect refused bindings/python/focal/a.py '    """A first line.

    Then it was told"""'
expect refused bindings/python/focal/a.py 'raise Error(f"{name} told")  # a string'
expect refused bindings/python/focal/a.py 'a = b  # told'
expect accepted bindings/python/focal/a.py 'told = a is None'
expect accepted bindings/python/focal/a.py '"""is None of them"""; told = "#"; told = 1'

# The table is the list: a new row counts at once, and without rows nothing is proved.
# shellcheck disable=SC2016  # backquotes are text
printf '# A guide\n\n## Words\n\n| `flummox*` | confuse |\n' > "$tree/CONTRIBUTING.md"
echo 'It flummoxes.' > "$tree/README.md"
"$here/check.sh" "$tree" > "$tree/out" 2>&1 && { echo "a new row of the table is not heeded"; wrong=$((wrong + 1)); }
grep -q '^README.md:1: "flummoxes"$' "$tree/out" || { echo "the report lacks file and line"; wrong=$((wrong + 1)); }
echo '# A guide' > "$tree/CONTRIBUTING.md"
"$here/check.sh" "$tree" > "$tree/out" 2>&1 && { echo "a guide without a table is accepted"; wrong=$((wrong + 1)); }

[ "$wrong" -eq 0 ] && echo "the prose check catches what it must"
