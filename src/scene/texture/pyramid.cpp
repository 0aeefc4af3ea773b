// Builds mip pyramids. A level's texel is the mean, in the linear domain, of the area that it covers in the level
// above: 2 x 2 texels where that size is even, three weighted ones along an odd side. 8-bit levels are rounded to the
// nearest byte by comparison with stored thresholds, so no elementary function runs per texel.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "scene/texture/texture.h"

namespace relook {
namespace {

constexpr std::size_t kChannels = 4;

double linear_of_srgb(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

/// Conversion between bytes and linear values of one channel.
class ByteCode {
 public:
  explicit ByteCode(bool srgb) {
    const auto linear = [srgb](double s) { return srgb ? linear_of_srgb(s) : s; };
    for (std::size_t i = 0; i < 256; ++i) linear_[i] = static_cast<float>(linear(static_cast<double>(i) / 255.0));
    for (std::size_t i = 0; i < 255; ++i)
      threshold_[i] = static_cast<float>(linear((static_cast<double>(i) + 0.5) / 255.0));
    threshold_[255] = 2.0F;
    std::size_t code = 0;
    for (std::size_t i = 0; i < start_.size(); ++i) {
      const float lowest = static_cast<float>(i) / static_cast<float>(start_.size());
      while (threshold_[code] <= lowest) ++code;
      start_[i] = static_cast<std::uint8_t>(code);
    }
  }
  [[nodiscard]] float linear(std::uint8_t byte) const { return linear_[byte]; }
  /// The byte whose value is nearest in the encoded domain, for 0 <= value <= 1.
  [[nodiscard]] std::uint8_t byte(float value) const {
    const auto bucket = static_cast<std::size_t>(value * static_cast<float>(start_.size()));
    std::size_t code = start_[std::min(bucket, start_.size() - 1)];
    while (threshold_[code] <= value) ++code;
    return static_cast<std::uint8_t>(code);
  }

 private:
  std::array<float, 256> linear_;
  std::array<float, 256> threshold_;  // values from threshold_[i] on belong to i + 1 or above
  std::array<std::uint8_t, 4096> start_;
};

/// Which texels of a side of `from` texels one texel of the next level covers, and how much of each.
struct Footprint {
  std::uint32_t first = 0, count = 1;
  std::array<float, 3> weights{1, 0, 0};
};

Footprint footprint(std::uint32_t i, std::uint32_t from) {
  if (from == 1) return {};
  if (from % 2 == 0) return {2 * i, 2, {0.5F, 0.5F, 0}};
  const std::uint32_t half = from / 2;
  const auto share = [from](std::uint32_t part) { return static_cast<float>(part) / static_cast<float>(from); };
  return {2 * i, 3, {share(half - i), share(half), share(i + 1)}};
}

std::uint32_t next_size(std::uint32_t size) { return std::max(size / 2, 1U); }

/// The levels' sizes and places; returns the number of texels of all.
std::uint64_t lay_out_levels(TexturePyramid& pyramid, std::uint32_t width, std::uint32_t height) {
  std::uint64_t offset = 0;
  while (true) {
    pyramid.levels.push_back({width, height, offset});
    offset += std::uint64_t{width} * height;
    if (width == 1 && height == 1) return offset;
    width = next_size(width);
    height = next_size(height);
  }
}

/// Fills every level below the first. load(texel, channel) is linear; store(texel, channel, value).
template <class Load, class Store>
void fill_levels(const TexturePyramid& pyramid, const Load& load, const Store& store) {
  for (std::size_t k = 1; k < pyramid.levels.size(); ++k) {
    const auto& above = pyramid.levels[k - 1];
    const auto& level = pyramid.levels[k];
    const auto fill_row = [&](std::size_t y) {
      const Footprint rows = footprint(static_cast<std::uint32_t>(y), above.height);
      for (std::uint32_t x = 0; x < level.width; ++x) {
        const Footprint columns = footprint(x, above.width);
        std::array<float, kChannels> sum{};
        for (std::uint32_t j = 0; j < rows.count; ++j)
          for (std::uint32_t i = 0; i < columns.count; ++i) {
            const float weight = rows.weights[j] * columns.weights[i];
            const std::uint64_t texel = above.offset + std::uint64_t{rows.first + j} * above.width + columns.first + i;
            for (std::size_t c = 0; c < kChannels; ++c) sum[c] += weight * load(texel, c);
          }
        const std::uint64_t texel = level.offset + y * level.width + x;
        for (std::size_t c = 0; c < kChannels; ++c) store(texel, c, sum[c]);
      }
    };
    constexpr std::size_t kTexelsPerTask = 16384;
    parallel_for(level.height, fill_row, std::max<std::size_t>(kTexelsPerTask / level.width, 1));
  }
}

/// The smallest and the largest value of each channel of level 0. Encoded bytes have the order of their values.
template <class Number>
std::array<std::array<Number, kChannels>, 2> extremes(const std::vector<Number>& texels, std::uint64_t count) {
  std::array<Number, kChannels> low, high;
  for (std::size_t c = 0; c < kChannels; ++c) low[c] = high[c] = texels[c];
  for (std::size_t i = 0; i < count * kChannels; i += kChannels)
    for (std::size_t c = 0; c < kChannels; ++c) {
      low[c] = std::min(low[c], texels[i + c]);
      high[c] = std::max(high[c], texels[i + c]);
    }
  return {low, high};
}

}  // namespace

TexturePyramid build_pyramid(TexelFormat format, std::uint32_t width, std::uint32_t height,
                             std::vector<std::uint8_t> texels) {
  TexturePyramid pyramid;
  pyramid.format = format;
  pyramid.texels8 = std::move(texels);
  pyramid.texels8.resize(lay_out_levels(pyramid, width, height) * kChannels);
  const ByteCode color(format == TexelFormat::srgb8), alpha(false);
  const auto load = [&](std::uint64_t texel, std::size_t c) {
    return (c == 3 ? alpha : color).linear(pyramid.texels8[texel * kChannels + c]);
  };
  const auto store = [&](std::uint64_t texel, std::size_t c, float value) {
    pyramid.texels8[texel * kChannels + c] = (c == 3 ? alpha : color).byte(value);
  };
  const auto [low, high] = extremes(pyramid.texels8, std::uint64_t{width} * height);
  pyramid.smallest = Rgba(color.linear(low[0]), color.linear(low[1]), color.linear(low[2]), alpha.linear(low[3]));
  pyramid.largest = Rgba(color.linear(high[0]), color.linear(high[1]), color.linear(high[2]), alpha.linear(high[3]));
  fill_levels(pyramid, load, store);
  return pyramid;
}

TexturePyramid build_pyramid(std::uint32_t width, std::uint32_t height, std::vector<float> texels) {
  TexturePyramid pyramid;
  pyramid.format = TexelFormat::float32;
  pyramid.texels32 = std::move(texels);
  pyramid.texels32.resize(lay_out_levels(pyramid, width, height) * kChannels);
  const auto load = [&](std::uint64_t texel, std::size_t c) { return pyramid.texels32[texel * kChannels + c]; };
  const auto store = [&](std::uint64_t texel, std::size_t c, float value) {
    pyramid.texels32[texel * kChannels + c] = value;
  };
  const auto [low, high] = extremes(pyramid.texels32, std::uint64_t{width} * height);
  pyramid.smallest = Rgba(low[0], low[1], low[2], low[3]);
  pyramid.largest = Rgba(high[0], high[1], high[2], high[3]);
  fill_levels(pyramid, load, store);
  return pyramid;
}

}  // namespace relook
