#include "compare/compare.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"

namespace relook {
namespace {

/// A share of places spread evenly over the image, at least the first one.
bool is_compared(std::size_t place, double percent) {
  const auto reached = [&](std::size_t tiles) { return std::ceil(static_cast<double>(tiles) * percent / 100); };
  return percent >= 100 || reached(place + 1) > reached(place);
}

void compare_pixel(const Rgba& a, const Rgba& b, FrameDifference& difference) {
  ++difference.pixels_compared;
  if (std::memcmp(&a, &b, sizeof a) == 0) return;
  ++difference.pixels_different;
  for (const auto channel : {&Rgba::r, &Rgba::g, &Rgba::b, &Rgba::a}) {
    if (std::memcmp(&(a.*channel), &(b.*channel), sizeof(float)) == 0) continue;
    double error = std::abs(double{a.*channel} - double{b.*channel});
    if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
    difference.max_error = std::max(difference.max_error, error);
    difference.squares += error * error;
  }
}

void update_rms(FrameDifference& difference) {
  const double channels = 4 * static_cast<double>(difference.pixels_compared);
  difference.rms_error = channels > 0 ? std::sqrt(difference.squares / channels) : 0;
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

FrameDifference& FrameDifference::operator+=(const FrameDifference& other) {
  pixels_compared += other.pixels_compared;
  pixels_different += other.pixels_different;
  max_error = std::max(max_error, other.max_error);
  squares += other.squares;
  update_rms(*this);
  return *this;
}

FrameDifference compare_frames(const Frame& a, const Frame& b) { return compare_frames(a, b, 100); }

FrameDifference compare_frames(const Frame& a, const Frame& b, double percent, std::size_t round) {
  require(a.width == b.width && a.height == b.height, "frames of one size are compared");
  FrameDifference difference;
  const std::size_t tiles = tile_count(a.width, a.height);
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    if (!is_compared((tile + round) % tiles, percent)) continue;
    const TileRect rect = tile_rect(tile, a.width, a.height);
    for (std::uint32_t y = rect.y0; y < rect.y1; ++y) {
      for (std::uint32_t x = rect.x0; x < rect.x1; ++x) {
        const std::size_t pixel = std::size_t{y} * a.width + x;
        compare_pixel(a.pixels[pixel], b.pixels[pixel], difference);
      }
    }
  }
  update_rms(difference);
  return difference;
}

Json difference_json(const FrameDifference& difference) {
  return {{"pixels_compared", difference.pixels_compared},
          {"pixels_different", difference.pixels_different},
          {"max_error", finite_or_null(difference.max_error)},
          {"rms_error", finite_or_null(difference.rms_error)}};
}

}  // namespace relook
