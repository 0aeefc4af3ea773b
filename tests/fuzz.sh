#!/bin/sh
# sh tests/fuzz.sh SECONDS [TARGET...]: builds the fuzz targets (tests/fuzz/fuzz_targets.h; all, unless named) with
# clang, AddressSanitizer and UndefinedBehaviorSanitizer, and runs each for SECONDS seconds, side by side on all cores,
# from tests/fuzz/seeds.py and the kept corpus (tests/fuzz/corpus). Prints a line a target; exits 1 if anything was
# found. Installs missing Debian packages first. Writes to build/ and to /dev/shm only. `sh tests/fuzz.sh keep [TARGET...]`
# instead takes into the kept corpus what runs have found that reaches other code; small files only.
set -eu
cd "$(dirname "$0")/.."
seconds=${1:?usage: sh tests/fuzz.sh SECONDS|keep [TARGET...]}
shift
targets="${*:-scene packed patch journal cache image notes replay}"
. scenes/setup.sh
packages="$packages clang-16 libclang-rt-16-dev"
install_packages
echo "Building the fuzz targets in build/asan (some minutes the first time)"
cmake --preset asan --log-level=WARNING >/dev/null
programs=""
for target in $targets; do programs="$programs fuzz_$target"; done
work=build/fuzz
mkdir -p "$work"
cmake --build --preset asan -j "$(nproc)" --target $programs >"$work/build.log" 2>&1 || {
  tail -40 "$work/build.log" >&2
  exit 1
}
memory=$(mktemp -d /dev/shm/relook_fuzz.XXXXXX 2>/dev/null || mktemp -d)
trap 'rm -rf "$memory"' EXIT
trap 'exit 130' INT TERM
export TMPDIR="$memory"
# Libraries that are not ours keep some memory to the end; leaks there are not what is looked for.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0
export UBSAN_OPTIONS=print_stacktrace=1
rm -rf "$work/seeds"
python3 tests/fuzz/seeds.py "$work/seeds"
most_bytes=8192

if [ "$seconds" = keep ]; then
  for target in $targets; do
    kept="tests/fuzz/corpus/$target"
    rm -rf "$work/kept_$target"
    mkdir -p "$work/kept_$target" "$work/found/$target" "$kept"
    "build/asan/fuzz_$target" -set_cover_merge=1 -max_len=$most_bytes -timeout=10 "$work/kept_$target" "$kept" "$work/seeds/$target" \
      "$work/found/$target" >"$work/keep_$target.log" 2>&1
    python3 tests/fuzz/choose.py "$work/kept_$target" "$work/seeds/$target" "$kept"
  done
  exit 0
fi

# run TARGET: its last lines go to $work/TARGET.log.
run() {
  mkdir -p "$work/found/$1" "$work/crashes/$1" "tests/fuzz/corpus/$1"
  "build/asan/fuzz_$1" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=512 \
    -max_len=$most_bytes -dict=tests/fuzz/gltf.dict -artifact_prefix="$work/crashes/$1/" -print_final_stats=1 \
    "$work/found/$1" "tests/fuzz/corpus/$1" "$work/seeds/$1" >"$work/$1.log" 2>&1 || echo $? >"$work/$1.failed"
}
for target in $targets; do rm -rf "$work/$target.failed" "$work/crashes/$target"; done
export seconds work most_bytes
echo "Fuzzing $targets, $seconds s each"
running=0
for target in $targets; do
  run "$target" &
  running=$((running + 1))
  [ $((running % $(nproc))) -ne 0 ] || wait
done
wait

found=0
printf '%-8s %10s %8s %8s %9s\n' target runs edges crashes time-outs
for target in $targets; do
  log="$work/$target.log"
  runs=$(LC_ALL=C sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -1)
  edges=$(grep -ao 'cov: [0-9]*' "$log" | tail -1 | cut -d' ' -f2)
  slow=$(find "$work/crashes/$target" -name 'timeout-*' | wc -l)
  crashes=$(find "$work/crashes/$target" -type f ! -name 'timeout-*' ! -name 'slow-unit-*' | wc -l)
  printf '%-8s %10s %8s %8d %9d\n' "$target" "${runs:-?}" "${edges:-?}" "$crashes" "$slow"
  if [ -e "$work/$target.failed" ]; then
    found=1
    find "$work/crashes/$target" -type f ! -name 'slow-unit-*' | sed 's/^/  found: /'
    echo "  its end: $log"
  fi
done
exit $found
