#include "scene/texture/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/portable_math.h"
#include "scene/texture/texel_taps.h"

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

struct Pair {
  std::uint32_t first, second;
};
/// A texel coordinate and the next one, in [0, size).
Pair wrapped_pair(std::int64_t i, std::uint32_t size, Wrap wrap) {
  if (wrap != Wrap::repeat) return {wrapped(i, size, wrap), wrapped(i + 1, size, wrap)};
  const bool is_power_of_two = (size & (size - 1)) == 0;
  const std::uint32_t first = is_power_of_two ? static_cast<std::uint32_t>(i) & (size - 1) : wrapped(i, size, wrap);
  return {first, first + 1 == size ? 0 : first + 1};
}

/// A number without its fraction. Requires |x| < 2^63.
struct Floor {
  std::int64_t whole;
  float fraction;
};
Floor floor_of(float x) {
  auto whole = static_cast<std::int64_t>(x);
  float rounded = static_cast<float>(whole);
  const bool is_above = rounded > x;
  whole -= is_above ? 1 : 0;
  rounded -= is_above ? 1.0F : 0.0F;
  return {whole, x - rounded};
}

void find_nearest(const TexturePyramid::Level& level, Uv uv, const TextureSampler& sampler,
                  TexelTaps::Square& square) {
  const float x = uv.x * static_cast<float>(level.width), y = uv.y * static_cast<float>(level.height);
  const std::uint64_t row = wrapped(floor_of(y).whole, level.height, sampler.wrap_t);
  square.texels[0] = level.offset + row * level.width + wrapped(floor_of(x).whole, level.width, sampler.wrap_s);
}

void find_four(const TexturePyramid::Level& level, Uv uv, const TextureSampler& sampler, TexelTaps::Square& square) {
  const Floor x = floor_of(uv.x * static_cast<float>(level.width) - 0.5F);
  const Floor y = floor_of(uv.y * static_cast<float>(level.height) - 0.5F);
  const Pair columns = wrapped_pair(x.whole, level.width, sampler.wrap_s);
  const Pair rows = wrapped_pair(y.whole, level.height, sampler.wrap_t);
  const std::size_t above = level.offset + std::uint64_t{rows.first} * level.width;
  const std::size_t below = level.offset + std::uint64_t{rows.second} * level.width;
  square.texels[0] = above + columns.first;
  square.texels[1] = above + columns.second;
  square.texels[2] = below + columns.first;
  square.texels[3] = below + columns.second;
  square.right = x.fraction;
  square.below = y.fraction;
}

/// read(texel) is linear.
template <class Read>
Rgba mean_of(const TexelTaps::Square& square, bool is_nearest, const Read& read) {
  const Rgba first = read(square.texels[0]);
  if (is_nearest) return first;
  const float u = square.right, v = square.below;
  const Rgba above = first * (1.0F - u) + read(square.texels[1]) * u;
  const Rgba below = read(square.texels[2]) * (1.0F - u) + read(square.texels[3]) * u;
  return above * (1.0F - v) + below * v;
}

template <class Read>
Rgba mean_of(const TexelTaps& taps, const Read& read) {
  const Rgba fine = mean_of(taps.fine, taps.is_nearest, read);
  if (!taps.has_coarse) return fine;
  const Rgba coarse = mean_of(taps.coarse, taps.is_nearest, read);
  return fine * (1.0F - taps.coarse_share) + coarse * taps.coarse_share;
}

/// From here on a texel coordinate has hardly a fraction left: such lookups read uv (0, 0).
constexpr float kLargestUv = 1e6F;

/// More than any pyramid has.
constexpr float kMostLevels = 64;

}  // namespace

void find_taps(const TexturePyramid& pyramid, Uv uv, float level, const TextureSampler& sampler, TexelTaps& taps) {
  if (!(std::fabs(uv.x) < kLargestUv) || !(std::fabs(uv.y) < kLargestUv)) uv = Uv(0, 0);
  const bool is_minified = level > 0;
  const bool is_nearest = (is_minified ? sampler.minified : sampler.magnified) == TexelFilter::nearest;
  bool has_coarse = false;
  float coarse_share = 0;
  const auto find = [&](std::size_t index, TexelTaps::Square& square) {
    const TexturePyramid::Level& from = pyramid.levels[index];
    is_nearest ? find_nearest(from, uv, sampler, square) : find_four(from, uv, sampler, square);
  };
  const std::size_t last = pyramid.levels.size() - 1;
  std::size_t index = 0;
  if (is_minified && sampler.levels != LevelFilter::full) {
    if (sampler.levels == LevelFilter::nearest) level = portable_floor(std::fmin(level, kMostLevels) + 0.5F);
    if (level >= static_cast<float>(last)) {
      index = last;
    } else {
      const float whole = portable_floor(level);
      index = static_cast<std::size_t>(whole);
      has_coarse = sampler.levels == LevelFilter::linear;
      coarse_share = level - whole;
    }
  }
  find(index, taps.fine);
  if (has_coarse) find(index + 1, taps.coarse);
  taps.has_coarse = has_coarse;
  taps.coarse_share = coarse_share;
  taps.is_nearest = is_nearest;
}

Rgba value_of(const TexturePyramid& pyramid, const TexelTaps& taps) {
  if (pyramid.format == TexelFormat::float32)
    return mean_of(taps, [texels = pyramid.texels32.data()](std::size_t texel) {
      const float* t = texels + texel * 4;
      return Rgba(t[0], t[1], t[2], t[3]);
    });
  const ByteTable& alpha = linear_of_byte();
  const ByteTable& color = pyramid.format == TexelFormat::srgb8 ? linear_of_srgb() : alpha;
  return mean_of(taps, [&, texels = pyramid.texels8.data()](std::size_t texel) {
    const std::uint8_t* t = texels + texel * 4;
    return Rgba(color[t[0]], color[t[1]], color[t[2]], alpha[t[3]]);
  });
}

Rgba sample(const TexturePyramid& pyramid, Uv uv, float level, const TextureSampler& sampler) {
  TexelTaps taps;
  find_taps(pyramid, uv, level, sampler, taps);
  return value_of(pyramid, taps);
}

}  // namespace relook
