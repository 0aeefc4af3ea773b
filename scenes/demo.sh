#!/bin/sh
# Builds relook, preprocesses scenes/spheres and replays the journal with one step for each row of the paper's Table 1.
# Installs missing Debian packages first (it says which; as root or through sudo). Writes to build/ only.
set -eu
cd "$(dirname "$0")/.."
. scenes/setup.sh
install_packages
build relook

relook=build/release/relook
out=build/demo
rm -rf "$out"
mkdir -p "$out"
"$relook" preprocess scenes/spheres/spheres.gltf -o "$out/spheres.cache" --resolution 960x540 --samples 4
"$relook" replay "$out/spheres.cache" journals/table1.json -o "$out/table1" --baseline --overlays

echo
echo "Frames:   $PWD/$out/table1/frames/0000.exr and on, one for each step"
echo "Previews: $PWD/$out/table1/previews/0000.png and on, for any image viewer"
echo "Report:   $PWD/$out/table1/report.html, what each step did to the picture, what it cost and what it could skip:"
echo "          for a web browser; report.json says the same to programs"
