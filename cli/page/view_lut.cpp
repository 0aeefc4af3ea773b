#include "page/view_lut.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "frame/deflate.h"
#include "page/page.h"

namespace relook {
namespace {

constexpr std::size_t kSide = ViewLut::kSize, kColors = kSide * kSide * kSide;
constexpr float kLowest = -1, kHighest = 16;  // display values that a lattice can hold

double stops_at(double linear) { return std::log2(1 + linear / ViewLut::kOffset); }

/// The linear value at a place along a side, 0..kSide - 1.
double linear_at(double place) {
  return ViewLut::kOffset * (std::exp2(place / (kSide - 1) * stops_at(ViewLut::kMost)) - 1);
}

/// A place along a side, in cells.
double place_of(double linear) {
  if (!(linear > 0)) return 0;  // NaN, too
  return stops_at(std::min(linear, ViewLut::kMost)) / stops_at(ViewLut::kMost) * (kSide - 1);
}

float bounded(float value) { return value > kLowest ? std::min(value, kHighest) : kLowest; }

/// A number in [0, 1): the digits of i in a base, mirrored (Halton 1960).
double mirrored(std::size_t i, std::size_t base) {
  double value = 0, digit = 1;
  for (; i > 0; i /= base) value += (digit /= static_cast<double>(base)) * static_cast<double>(i % base);
  return value;
}

double code8(float value) { return value > 0 ? std::min(value, 1.0F) * 255.0 : 0.0; }

}  // namespace

ViewLut::ViewLut(const DisplayView& view) : codes_(3 * kColors) {
  std::vector<Rgba> shown(kColors);
  parallel_for(kSide, [&](std::size_t blue) {
    for (std::size_t i = 0; i < kSide * kSide; ++i)
      shown[blue * kSide * kSide + i] = view.apply(Rgba(static_cast<float>(linear_at(static_cast<double>(i % kSide))),
                                                        static_cast<float>(linear_at(static_cast<double>(i / kSide))),
                                                        static_cast<float>(linear_at(static_cast<double>(blue))), 1));
  });
  for (Rgba& color : shown) {
    for (int channel = 0; channel < 3; ++channel) {
      color[channel] = bounded(color[channel]);
      low_ = std::min(low_, color[channel]);
      high_ = std::max(high_, color[channel]);
    }
  }
  for (std::size_t i = 0; i < kColors; ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      codes_[channel * kColors + i] = static_cast<std::uint16_t>(
          std::lround((shown[i][static_cast<int>(channel)] - low_) / (high_ - low_) * 65535.0F));
  error_ = measured(view);
}

/// From the corner that is nearest to black along the axes, the one with the largest rest first (Kasson et al. 1995).
Rgba ViewLut::show(const Rgba& linear) const {
  constexpr std::array<std::size_t, 3> kStride{1, kSide, kSide * kSide};
  std::array<double, 3> rest{};
  std::array<int, 3> order{0, 1, 2};
  std::size_t corner = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = place_of(linear[static_cast<int>(axis)]);
    const auto cell = std::min(static_cast<std::size_t>(place), kSide - 2);
    rest[axis] = place - static_cast<double>(cell);
    corner += cell * kStride[axis];
  }
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](int axis) { return rest[static_cast<std::size_t>(axis)]; });
  std::array<double, 3> value{};
  double before = 1;
  const auto add = [&](double weight) {
    for (std::size_t channel = 0; channel < 3; ++channel)
      value[channel] += weight * static_cast<double>(codes_[channel * kColors + corner]);
  };
  for (const int axis : order) {
    const double here = rest[static_cast<std::size_t>(axis)];
    add(before - here);
    corner += kStride[static_cast<std::size_t>(axis)];
    before = here;
  }
  add(before);
  const auto display = [&](double code) { return static_cast<float>(low_ + code * (high_ - low_) / 65535); };
  return {display(value[0]), display(value[1]), display(value[2]), 1};
}

ViewLut::Error ViewLut::measured(const DisplayView& view) const {
  constexpr std::size_t kPoints = 4096;
  std::vector<std::array<double, 3>> errors(kPoints);
  parallel_for(kPoints / 64, [&](std::size_t part) {
    for (std::size_t i = part * 64; i < part * 64 + 64; ++i) {
      const auto value = [&](std::size_t base) {
        return static_cast<float>(linear_at(mirrored(i, base) * (kSide - 1)));
      };
      const Rgba linear = i % 4 == 0 ? Rgba(value(3), value(3), value(3), 1) : Rgba(value(2), value(3), value(5), 1);
      const Rgba wanted = view.apply(linear), found = show(linear);
      for (int channel = 0; channel < 3; ++channel)
        errors[i][static_cast<std::size_t>(channel)] = std::abs(code8(wanted[channel]) - code8(found[channel]));
    }
  });
  Error error{0, 0, kPoints};
  for (const auto& each : errors) {
    for (const double value : each) {
      error.mean += value / (3.0 * kPoints);
      error.most = std::max(error.most, value);
    }
  }
  return error;
}

Json ViewLut::json() const {
  std::vector<unsigned char> bytes(2 * codes_.size());
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    const unsigned before = i % kColors == 0 ? 0 : codes_[i - 1], difference = (codes_[i] - before) & 0xFFFF;
    bytes[i] = static_cast<unsigned char>(difference & 0xFF);
    bytes[codes_.size() + i] = static_cast<unsigned char>(difference >> 8);
  }
  return {{"size", kSize},
          {"offset", kOffset},
          {"most", kMost},
          {"low", low_},
          {"high", high_},
          {"error", {{"mean", error_.mean}, {"most", error_.most}, {"points", error_.points}}},
          {"codes", base64(Deflater().zlib(bytes))}};
}

Json view_lut_json(const DisplayView& view) {
  Json json = ViewLut(view).json();
  json["name"] = view.name();
  return json;
}

}  // namespace relook
