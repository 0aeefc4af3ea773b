#include "scene/texture/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/portable_math.h"

namespace relook {
namespace {

using ByteTable = std::array<float, 256>;

const ByteTable& linear_of_srgb() {
  static const ByteTable table = [] {
    ByteTable values{};
    for (int i = 0; i < 256; ++i) {
      const double s = i / 255.0;
      values[static_cast<std::size_t>(i)] =
          static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return values;
  }();
  return table;
}

const ByteTable& linear_of_byte() {
  static const ByteTable table = [] {
    ByteTable values{};
    for (int i = 0; i < 256; ++i) values[static_cast<std::size_t>(i)] = static_cast<float>(i) / 255.0F;
    return values;
  }();
  return table;
}

/// Maps a texel coordinate into [0, size).
std::uint32_t wrapped(std::int64_t i, std::uint32_t size, Wrap wrap) {
  const auto n = static_cast<std::int64_t>(size);
  if (i >= 0 && i < n) return static_cast<std::uint32_t>(i);
  if (wrap == Wrap::clamp) return static_cast<std::uint32_t>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t period = wrap == Wrap::mirror ? 2 * n : n;
  std::int64_t r = i % period;
  if (r < 0) r += period;
  return static_cast<std::uint32_t>(r < n ? r : 2 * n - 1 - r);
}

struct Texels {
  const TexturePyramid& pyramid;
  const ByteTable& color;  // of the first three channels

  explicit Texels(const TexturePyramid& p)
      : pyramid(p), color(p.format == TexelFormat::srgb8 ? linear_of_srgb() : linear_of_byte()) {}

  [[nodiscard]] Rgba at(const TexturePyramid::Level& level, std::uint32_t x, std::uint32_t y) const {
    const std::size_t i = (level.offset + std::uint64_t{y} * level.width + x) * 4;
    if (pyramid.format == TexelFormat::float32) {
      const float* t = &pyramid.texels32[i];
      return Rgba(t[0], t[1], t[2], t[3]);
    }
    const std::uint8_t* t = &pyramid.texels8[i];
    return Rgba(color[t[0]], color[t[1]], color[t[2]], linear_of_byte()[t[3]]);
  }
};

Rgba nearest_texel(const Texels& texels, const TexturePyramid::Level& level, Uv uv, const TextureSampler& sampler) {
  const float x = uv.x * static_cast<float>(level.width), y = uv.y * static_cast<float>(level.height);
  return texels.at(level, wrapped(static_cast<std::int64_t>(std::floor(x)), level.width, sampler.wrap_s),
                   wrapped(static_cast<std::int64_t>(std::floor(y)), level.height, sampler.wrap_t));
}

Rgba bilinear(const Texels& texels, const TexturePyramid::Level& level, Uv uv, const TextureSampler& sampler) {
  const float cx = uv.x * static_cast<float>(level.width) - 0.5F;
  const float cy = uv.y * static_cast<float>(level.height) - 0.5F;
  const float fx = std::floor(cx), fy = std::floor(cy);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
  const std::uint32_t x0 = wrapped(ix, level.width, sampler.wrap_s), x1 = wrapped(ix + 1, level.width, sampler.wrap_s);
  const std::uint32_t y0 = wrapped(iy, level.height, sampler.wrap_t);
  const std::uint32_t y1 = wrapped(iy + 1, level.height, sampler.wrap_t);
  const float u = cx - fx, v = cy - fy;
  const Rgba top = texels.at(level, x0, y0) * (1.0F - u) + texels.at(level, x1, y0) * u;
  const Rgba bottom = texels.at(level, x0, y1) * (1.0F - u) + texels.at(level, x1, y1) * u;
  return top * (1.0F - v) + bottom * v;
}

/// From here on a texel coordinate has hardly a fraction left: such lookups read uv (0, 0).
constexpr float kLargestUv = 1e6F;

/// More than any pyramid has.
constexpr float kMostLevels = 64;

}  // namespace

Rgba sample(const TexturePyramid& pyramid, Uv uv, float level, const TextureSampler& sampler) {
  if (!(std::fabs(uv.x) < kLargestUv) || !(std::fabs(uv.y) < kLargestUv)) uv = Uv(0, 0);
  const Texels texels(pyramid);
  const bool is_minified = level > 0;
  const TexelFilter filter = is_minified ? sampler.minified : sampler.magnified;
  const auto read = [&](std::size_t index) {
    const TexturePyramid::Level& from = pyramid.levels[index];
    return filter == TexelFilter::nearest ? nearest_texel(texels, from, uv, sampler)
                                          : bilinear(texels, from, uv, sampler);
  };
  if (!is_minified || sampler.levels == LevelFilter::full) return read(0);
  if (sampler.levels == LevelFilter::nearest) level = portable_floor(std::fmin(level, kMostLevels) + 0.5F);
  if (level >= static_cast<float>(pyramid.levels.size() - 1)) return read(pyramid.levels.size() - 1);
  const float whole = portable_floor(level);
  const auto index = static_cast<std::size_t>(whole);
  const float t = level - whole;
  if (sampler.levels == LevelFilter::nearest) return read(index);
  const Rgba fine = read(index);
  const Rgba coarse = read(index + 1);
  return fine * (1.0F - t) + coarse * t;
}

}  // namespace relook
