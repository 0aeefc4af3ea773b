#!/bin/sh
# Builds relook and runs every test, two or more at a time. Installs missing Debian packages first (it says which; as
# root or through sudo). Writes to build/ and to the folder for temporary files only.
# Tests on other people's scenes read ../shared/assets and say that they skip when it is not there.
set -eu
cd "$(dirname "$0")/.."
. scenes/setup.sh
packages="$packages chromium chromium-driver"  # report.html is tried in a browser
install_packages
build relook relook_tests

if ctest --test-dir build/release -j "$(nproc)" --output-on-failure --timeout 900 --progress; then
  echo "All tests passed."
else
  echo "Some tests FAILED; their output is above." >&2
  exit 1
fi
