#!/bin/sh
# Builds relook and shows it twice. First a product shot under its own HDRI and area lights: its lights soloed and mixed,
# each step against a full render; then scenes/spheres and one step for each row of the paper's Table 1, under the paper's
# own integrator. Installs missing Debian packages first (it says which; as root or through sudo). Writes to build/ only.
set -eu
cd "$(dirname "$0")/.."
. scenes/setup.sh
install_packages
build relook

relook=build/release/relook
out=build/demo
rm -rf "$out"
mkdir -p "$out"
if [ ! -e build/scenes/product/product.gltf ]; then
  echo "Writing build/scenes/product ..."
  python3 scenes/generate.py product build/scenes/product
fi
"$relook" preprocess build/scenes/product/product.gltf -o "$out/product.cache" --resolution 480x270
"$relook" replay "$out/product.cache" journals/product-lights.json -o "$out/product" --baseline

"$relook" preprocess scenes/spheres/spheres.gltf -o "$out/spheres.cache" --integrator whitted \
  --resolution 960x540 --samples 4
"$relook" replay "$out/spheres.cache" journals/table1.json -o "$out/table1" --baseline --overlays

echo
echo "Frames:   $PWD/$out/product/frames/0000.exr and on, one for each step; $PWD/$out/table1/frames/0000.exr and on"
echo "Previews: $PWD/$out/product/previews/0000.png and on, for any image viewer; $PWD/$out/table1/previews/0000.png"
echo "Report:   $PWD/$out/product/report.html and $PWD/$out/table1/report.html, what each step did to the picture,"
echo "          what it cost and what it could skip: for a web browser; report.json says the same to programs"
