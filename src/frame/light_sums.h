// From sums of light to pixels: the frame of the path integrator is a sum of lights. Layer l of a pixel is
// float32(colour_l x S_l / N) in doubles, where S_l is the exact sum of the light's terms over the pixel's N samples,
// for a light of colour 1; R, G and B are the float32 sum of the layers, in the order of the lights, and A is
// float32(coverage / N). Sums while they change: TileSums; as they are kept: PackedSums.
// All pixels of a tile: image/tile_layers.h.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "base/math.h"
#include "light/sums/packed_sums.h"
#include "light/sums/tile_sums.h"

namespace relook {

/// Sums beside those of the lights: sky, ambient light, background, unlit surfaces.
inline constexpr std::size_t kSumsBesideLights = 4;

/// Colour times intensity of a light, linear RGB.
using LightColor = std::array<double, 3>;

/// What one light gives to a pixel. Requires, as below: finite colours, at most 1024 samples.
[[nodiscard]] inline Color layer(const std::array<double, 3>& sum, const LightColor& color, std::uint32_t samples) {
  return {static_cast<float>(color[0] * sum[0] / samples), static_cast<float>(color[1] * sum[1] / samples),
          static_cast<float>(color[2] * sum[2] / samples)};
}
[[nodiscard]] inline Color layer(const TileSums& sums, std::size_t sum, std::size_t pixel, const LightColor& color,
                                 std::uint32_t samples) {
  return layer(sums.value(sum, pixel), color, samples);
}
[[nodiscard]] inline Color layer(const PackedSums& sums, std::size_t sum, std::size_t pixel, const LightColor& color,
                                 std::uint32_t samples) {
  return layer(sums.value(sum, pixel), color, samples);
}

/// A pixel, of TileSums or PackedSums. `colors`: of all sums, in their order. The sum begins with +0, so that a layer
/// of zero, of either sign, changes nothing: lights without light may be left out.
template <class Sums>
[[nodiscard]] Rgba compose(const Sums& sums, std::size_t pixel, std::span<const LightColor> colors,
                           std::uint32_t samples) {
  Rgba color(0, 0, 0, static_cast<float>(sums.coverage(pixel) / samples));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Color of_light = layer(sums, i, pixel, colors[i], samples);
    color.r += of_light.x;
    color.g += of_light.y;
    color.b += of_light.z;
  }
  return color;
}

}  // namespace relook
