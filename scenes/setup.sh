# Sourced from the project's root by demo.sh and by the scripts in ../tests. Gives install_packages, which installs
# those of $packages that are missing (Debian 12), and build and build_preset, which configure and build targets.

# openimageio-tools: OpenImageIO's CMake files refuse to load without its programs.
packages="g++ cmake make pkg-config python3 libembree-dev libopenimageio-dev openimageio-tools openexr libopenexr-dev \
libimath-dev libtinygltf-dev nlohmann-json3-dev libcli11-dev libgtest-dev libtbb-dev libzstd-dev \
libxxhash-dev zlib1g-dev libisal-dev libopencolorio-dev libdraco-dev libmeshoptimizer-dev libwebp-dev libfreetype-dev fonts-dejavu-core \
libjs-chart.js"

install_packages() {
  missing=""
  for package in $packages; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
  done
  [ -n "$missing" ] || return 0
  if ! command -v apt-get >/dev/null; then
    echo "relook: no apt-get here; please install what these Debian packages hold:$missing" >&2
    return 1
  fi
  as_root=""
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "relook: run as root, or install sudo; missing:$missing" >&2; return 1; }
    as_root=sudo
  fi
  echo "Installing with apt-get:$missing"
  $as_root apt-get update -qq </dev/null
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing </dev/null
}

# build_preset PRESET TARGET...: out of date parts only.
build_preset() {
  preset=$1
  shift
  echo "Building $* in build/$preset (a few minutes the first time)"
  cmake --preset "$preset" --log-level=WARNING
  cmake --build --preset "$preset" -j "$(nproc)" --target "$@"
}

build() {
  build_preset release "$@"
}
