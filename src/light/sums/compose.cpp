#include <algorithm>

#include "base/error.h"
#include "frame/light_sums.h"

namespace relook {
namespace {

// The sum begins with +0, so that a layer of zero, of either sign, changes nothing: lights without light may be left
// out.
template <class Sums>
Rgba composed(const Sums& sums, std::size_t pixel, std::span<const LightColor> colors, std::uint32_t samples) {
  Rgba color(0, 0, 0, static_cast<float>(sums.coverage(pixel) / samples));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Color of_light = layer(sums, i, pixel, colors[i], samples);
    color.r += of_light.x;
    color.g += of_light.y;
    color.b += of_light.z;
  }
  return color;
}

}  // namespace

Rgba compose(const TileSums& sums, std::size_t pixel, std::span<const LightColor> colors, std::uint32_t samples) {
  return composed(sums, pixel, colors, samples);
}

Rgba compose(const PackedSums& sums, std::size_t pixel, std::span<const LightColor> colors, std::uint32_t samples) {
  return composed(sums, pixel, colors, samples);
}

void compose_tile(const PackedSums& sums, std::span<const LightColor> colors, std::uint32_t samples,
                  std::span<Rgba> pixels) {
  require(colors.size() == sums.sums() && pixels.size() == sums.pixels(), "a colour a sum, a place a pixel");
  for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel)
    pixels[pixel] = Rgba(0, 0, 0, static_cast<float>(sums.coverage(pixel) / samples));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const LightColor color = colors[i];
    if (sums.is_zero(i) || color == LightColor{0, 0, 0}) continue;
    for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
      const Color of_light = layer(sums, i, pixel, color, samples);
      pixels[pixel].r += of_light.x;
      pixels[pixel].g += of_light.y;
      pixels[pixel].b += of_light.z;
    }
  }
}

}  // namespace relook
