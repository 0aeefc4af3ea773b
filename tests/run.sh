#!/bin/sh
# Builds relook and runs every test, two or more at a time. Installs missing Debian packages first (it says which; as
# root or through sudo). Writes to build/ and to the folder for temporary files only.
# Tests on other people's scenes read ../shared/assets and skip when it is not there: the last lines say how many tests
# were skipped, and why. Exit code 1 when a test fails; a skipped test is no failure.
set -eu
cd "$(dirname "$0")/.."
. scenes/setup.sh
packages="$packages chromium chromium-driver"  # report.html is tried in a browser
packages="$packages python3-openimageio python3-numpy mypy"  # a recipe that reads layers; types of relook.py
install_packages
build relook relook_tests relook_printed

# summary WORDS: from ctest's log, why tests were skipped, a line for each reason; then "N WORDS, N skipped."
summary() {
  awk -v words="$1" '
    /^[0-9]+\/[0-9]+ Test: / { ++tests }
    /: Skipped$/ { is_reason = 1; reason = ""; next }  # as GTEST_SKIP prints it, then what the test says
    is_reason && /^\[  SKIPPED \] / {
      ++skipped
      ++times[reason == "" ? "no reason given: " $4 : reason]
      is_reason = 0
    }
    is_reason && $0 != "" { reason = reason (reason == "" ? "" : " ") $0 }
    END {
      if (skipped > 0) print "Skipped:"
      for (reason in times) printf "%6d  %s\n", times[reason], reason | "sort -k 2"
      close("sort -k 2")
      if (skipped > 0) printf "%d %s, %d skipped.\n", tests - skipped, words, skipped
      else printf "All %d %s.\n", tests, words
    }' build/release/Testing/Temporary/LastTest.log
}

if ctest --test-dir build/release -j "$(nproc)" --output-on-failure --timeout 900 --progress; then
  summary "tests passed"
else
  summary "tests ran"
  echo "Some tests FAILED; their output is above." >&2
  exit 1
fi
