// Mip pyramids and our own sampler (a library call costs as much as several rays). Texture values are pure functions of
// uv and level: the same bits on every machine. build_pyramid() is called by image.cpp, sample() wherever a texture is
// read: shading, alpha, displacement.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "base/math.h"

namespace relook {

/// How the stored texels become linear values.
enum class TexelFormat : std::uint8_t {
  srgb8,    // 4 bytes RGBA, RGB sRGB-encoded
  linear8,  // 4 bytes RGBA, value / 255
  float32,  // 4 floats RGBA, linear (16-bit and HDR images)
};

/// A mip pyramid of RGBA texels, level 0 first, each level half the size of the one before (rounded down, at least 1).
struct TexturePyramid {
  struct Level {
    std::uint32_t width = 0, height = 0;
    std::uint64_t offset = 0;  // in texels, from the start of the texel array; row 0 on top
  };
  TexelFormat format = TexelFormat::srgb8;
  std::vector<Level> levels;
  std::vector<std::uint8_t> texels8;  // srgb8, linear8: 4 per texel
  std::vector<float> texels32;        // float32: 4 per texel
  Rgba smallest, largest;             // over level 0, linear: what a parameter times this texture can reach
  float negative_share = 0;           // of a float image's light, values below 0 that decoding has made 0
};

enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// Which texels of a level a lookup takes: the nearest one, or the four around the place, mixed.
enum class TexelFilter : std::uint8_t { nearest, linear };
/// Which levels a minified lookup takes: the full image alone, the level nearest to the footprint, or two, mixed.
enum class LevelFilter : std::uint8_t { full, nearest, linear };

/// How a pyramid is read: a glTF sampler. Without filters, trilinearly.
struct TextureSampler {
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  TexelFilter magnified = TexelFilter::linear;  // where the footprint is a texel of level 0 or less
  TexelFilter minified = TexelFilter::linear;   // elsewhere
  LevelFilter levels = LevelFilter::linear;     // likewise
  bool operator==(const TextureSampler&) const = default;
};

/// The value at uv, which counts from the upper left corner of the image (glTF). level: log2 of the footprint in texels
/// of level 0, clamped to the pyramid. Non-finite uv reads (0, 0).
[[nodiscard]] Rgba sample(const TexturePyramid& pyramid, Uv uv, float level, const TextureSampler& sampler);

/// Builds the pyramid from level 0. texels: width * height * 4 values in [0, 255], row 0 on top. Box filter in the
/// linear domain.
[[nodiscard]] TexturePyramid build_pyramid(TexelFormat format, std::uint32_t width, std::uint32_t height,
                                           std::vector<std::uint8_t> texels);
[[nodiscard]] TexturePyramid build_pyramid(std::uint32_t width, std::uint32_t height, std::vector<float> texels);

}  // namespace relook
