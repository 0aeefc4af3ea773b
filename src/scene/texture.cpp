#include "scene/texture.h"

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

Rgba bilinear(const Texels& texels, const TexturePyramid::Level& level, Uv uv, Wrap wrap_s, Wrap wrap_t, bool nearest) {
  const float x = uv.x * static_cast<float>(level.width), y = uv.y * static_cast<float>(level.height);
  if (nearest)
    return texels.at(level, wrapped(static_cast<std::int64_t>(std::floor(x)), level.width, wrap_s),
                     wrapped(static_cast<std::int64_t>(std::floor(y)), level.height, wrap_t));
  const float cx = x - 0.5F, cy = y - 0.5F;
  const float fx = std::floor(cx), fy = std::floor(cy);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
  const std::uint32_t x0 = wrapped(ix, level.width, wrap_s), x1 = wrapped(ix + 1, level.width, wrap_s);
  const std::uint32_t y0 = wrapped(iy, level.height, wrap_t), y1 = wrapped(iy + 1, level.height, wrap_t);
  const float u = cx - fx, v = cy - fy;
  const Rgba top = texels.at(level, x0, y0) * (1.0F - u) + texels.at(level, x1, y0) * u;
  const Rgba bottom = texels.at(level, x0, y1) * (1.0F - u) + texels.at(level, x1, y1) * u;
  return top * (1.0F - v) + bottom * v;
}

/// Beyond this a texel coordinate has no fraction left: such lookups read the corner.
constexpr float kLargestUv = 1e6F;

}  // namespace

Rgba sample(const TexturePyramid& pyramid, Uv uv, float level, Wrap wrap_s, Wrap wrap_t, bool nearest) {
  if (!(std::fabs(uv.x) < kLargestUv) || !(std::fabs(uv.y) < kLargestUv)) uv = Uv(0, 0);
  const Texels texels(pyramid);
  const auto last = static_cast<float>(pyramid.levels.size() - 1);
  if (!(level > 0)) return bilinear(texels, pyramid.levels.front(), uv, wrap_s, wrap_t, nearest);
  if (level >= last) return bilinear(texels, pyramid.levels.back(), uv, wrap_s, wrap_t, false);
  const float whole = portable_floor(level);
  const auto index = static_cast<std::size_t>(whole);
  const float t = level - whole;
  const Rgba fine = bilinear(texels, pyramid.levels[index], uv, wrap_s, wrap_t, false);
  const Rgba coarse = bilinear(texels, pyramid.levels[index + 1], uv, wrap_s, wrap_t, false);
  return fine * (1.0F - t) + coarse * t;
}

}  // namespace relook
