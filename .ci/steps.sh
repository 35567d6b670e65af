# shellcheck shell=sh
# Sourced: runs named steps and prints at the end where the time went.
steps_began=$(date +%s.%N)
steps_times=

step() {  # NAME COMMAND...
  steps_name=$1
  shift
  printf '== %s\n' "$steps_name"
  steps_start=$(date +%s.%N)
  "$@"
  steps_times="$steps_times$(steps_line "$steps_start" "$steps_name")
"
}

steps_line() { awk -v a="$1" -v b="$(date +%s.%N)" -v n="$2" 'BEGIN { printf "%8.1f s  %s", b - a, n }'; }

print_times() {
  printf '\nWhere the time went:\n%s%s\n\n' "$steps_times" "$(steps_line "$steps_began" "in all")"
}

# Real data is in FOCAL_EVALUATION_DATA, where it is.
if [ -z "${FOCAL_EVALUATION_DATA:-}" ] && [ -d ../shared/data ]; then
  FOCAL_EVALUATION_DATA=$(cd ../shared/data && pwd)
  export FOCAL_EVALUATION_DATA
fi
echo "evaluation data: ${FOCAL_EVALUATION_DATA:-none, the tests that need it are skipped}"

# Checks of every access for null, alignment and size take a third of the compiler's time; the address sanitizer ends at most of
# what they find, and `nightly` has them.
few_checks=-DFOCAL_SANITIZE_SKIP=null,alignment,object-size,vptr

build_with_sanitizers() {  # OPTION...; by clang: it takes a third less time to build than GCC, and warns of other things
  cmake --preset asan -DFOCAL_WERROR=ON -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ --log-level=NOTICE "$@" > /dev/null
  cmake --build --preset asan
}

# The longest tests with sanitizers. What they go through, the tests of the C interface and the samples go through as well, so
# only `nightly` runs them with sanitizers.
long_with_sanitizers='^(capi/descriptors_and_distances|samples/creatures|compute/host_backend|correspondence/dense_map|landmarks/(continuity|pipeline)|skeleton/(body_fit|detail_rig|rig_transfer))$'

# Real data is for the release build: the sanitizers look at the same code on the sample characters.
test_with_sanitizers() {  # ARGUMENT of ctest...
  env -u FOCAL_EVALUATION_DATA UBSAN_OPTIONS=print_stacktrace=1 ctest --preset asan --parallel "$(nproc)" "$@"
}
