#!/bin/sh
# Runs one file of tests of the Python package. Skips (77) where there is no python3 that can.
# usage: run.sh numpy|plain PACKAGE_FOLDER TEST.py [ARGUMENT...]
#   numpy: on a python3 that has NumPy; plain: on any python3, with NumPy hidden
# FOCAL_PYTHON names another interpreter than python3.
set -eu
kind=$1 package=$2
shift 2

interpreter=
for candidate in ${FOCAL_PYTHON:-python3 /usr/bin/python3}; do
  command -v "$candidate" > /dev/null || continue
  "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 9))' 2> /dev/null || continue
  [ "$kind" = plain ] || "$candidate" -c 'import numpy' 2> /dev/null || continue
  interpreter=$candidate
  break
done
if [ -z "$interpreter" ]; then
  [ "$kind" = plain ] && echo "skipped: no python3 of version 3.9 or later" \
    || echo "skipped: no python3 with NumPy (on Debian: python3-numpy)"
  exit 77
fi

unset FOCAL_LIBRARY PYTHONHOME
[ "$kind" = plain ] && export FOCAL_TEST_NO_NUMPY=1
export PYTHONPATH="$package" PYTHONDONTWRITEBYTECODE=1
exec "$interpreter" -W error "$@"
