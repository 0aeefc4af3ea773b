#!/bin/sh
# sh tests/sanitize.sh address|thread [CTEST OPTION...]: builds relook and its tests with a sanitizer and runs every test.
# Installs missing Debian packages first. Writes to build/ and to the folder for temporary files only.
# address: AddressSanitizer and UndefinedBehaviorSanitizer (build/asan); thread: ThreadSanitizer (build/tsan).
# Any report is a failure: of a test, or, where a test expects its program to fail, of this script.
set -eu
cd "$(dirname "$0")/.."
case "${1:-}" in
  address) preset=asan ;;
  thread) preset=tsan ;;
  *)
    echo "usage: sh tests/sanitize.sh address|thread [CTEST OPTION...]" >&2
    exit 2
    ;;
esac
shift
. scenes/setup.sh
packages="$packages chromium chromium-driver"
[ "$preset" != asan ] || packages="$packages clang-16 libclang-rt-16-dev llvm-16"
install_packages
build_preset "$preset" relook relook_tests

reports="$PWD/build/$preset/sanitizer-reports"
rm -rf "$reports"
mkdir -p "$reports"
# Each process writes a file of its own, so that nothing is lost in what a test catches.
# Libraries that are not ours keep some memory to the end: leaks are not looked for.
export ASAN_OPTIONS="log_path=$reports/asan:detect_leaks=0:allocator_may_return_null=1:detect_odr_violation=1"
export UBSAN_OPTIONS="log_path=$reports/ubsan:print_stacktrace=1:halt_on_error=1"
export TSAN_OPTIONS="log_path=$reports/tsan:suppressions=$PWD/tests/threads.supp:ignore_noninstrumented_modules=0:halt_on_error=0:exitcode=66:second_deadlock_stack=1"
result=0
# ThreadSanitizer of these compilers finds no room for its shadow where the system spreads addresses widely.
setarch "$(uname -m)" -R ctest --test-dir "build/$preset" -j "$(nproc)" --output-on-failure --timeout 3600 --progress "$@" ||
  result=1
# Not those of programs that have no room for a sanitizer's own memory: tests limit theirs.
found=$(grep -rlE 'Sanitizer: |runtime error:' "$reports" | sort || true)
if [ -n "$found" ]; then
  echo "Sanitizer reports, the last of which says:" >&2
  echo "$found" >&2
  head -40 "$(echo "$found" | tail -1)" >&2
  result=1
fi
[ "$result" != 0 ] || echo "All tests passed, no report."
exit "$result"
