#include "compare/flip.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "compare/flip_ldr.h"

namespace relook {
namespace {

constexpr std::size_t kSide = 128;  // of the squares that are done one by one

/// The ACES fit of K. Narkowicz with its pre-exposure of 0.6 taken back: (k0 x^2 + k1 x) / (k2 x^2 + k3 x + k4).
struct ToneCurve {
  double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03, k2 = 0.6 * 0.6 * 2.43, k3 = 0.6 * 0.59, k4 = 0.14;

  [[nodiscard]] float operator()(float value) const {
    constexpr float kBrightest = 1e9F;  // its square is finite; mapped to 1
    const double x = std::clamp(value, 0.0F, kBrightest);
    return static_cast<float>(std::clamp((k0 * x + k1) * x / ((k2 * x + k3) * x + k4), 0.0, 1.0));
  }
  /// The larger x that is mapped to t.
  [[nodiscard]] double inverse(double t) const {
    const double half = 0.5 * (k1 - t * k3) / (k0 - t * k2), product = -t * k4 / (k0 - t * k2);
    return -half + std::sqrt(half * half - product);
  }
};

/// Pixels [x0, x1) x [y0, y1).
struct Square {
  std::size_t x0, y0, x1, y1;
};

std::vector<Square> squares(const Frame& frame) {
  std::vector<Square> all;
  for (std::size_t y = 0; y < frame.height; y += kSide)
    for (std::size_t x = 0; x < frame.width; x += kSide)
      all.push_back(
          {x, y, std::min<std::size_t>(x + kSide, frame.width), std::min<std::size_t>(y + kSide, frame.height)});
  return all;
}

/// Whether the frames differ in what the filters see from the square.
bool sees_difference(const Frame& a, const Frame& b, const Square& square) {
  const std::size_t x0 = square.x0 - std::min(square.x0, kFlipRadius),
                    y0 = square.y0 - std::min(square.y0, kFlipRadius);
  const std::size_t x1 = std::min<std::size_t>(square.x1 + kFlipRadius, a.width);
  const std::size_t y1 = std::min<std::size_t>(square.y1 + kFlipRadius, a.height);
  for (std::size_t y = y0; y < y1; ++y) {
    const std::size_t first = y * a.width + x0;
    if (std::memcmp(&a.pixels[first], &b.pixels[first], (x1 - x0) * sizeof(Rgba)) != 0) return true;
  }
  return false;
}

/// The square and what the filters see beyond it; the frame's last rows and columns go on for ever.
RgbGrids exposed(const Frame& frame, const Square& square, double exposure) {
  const std::size_t width = square.x1 - square.x0 + 2 * kFlipRadius, height = square.y1 - square.y0 + 2 * kFlipRadius;
  RgbGrids grids{Grid(width, height), Grid(width, height), Grid(width, height)};
  const auto scale = static_cast<float>(std::exp2(exposure));
  const ToneCurve curve;
  const auto inside = [](std::size_t place, std::size_t side) {
    return std::min(place - std::min(place, kFlipRadius), side - 1);
  };
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t column = inside(square.x0 + x, frame.width), row = inside(square.y0 + y, frame.height);
      const Rgba& pixel = frame.pixels[row * frame.width + column];
      grids.r.values[y * width + x] = curve(scale * pixel.r);
      grids.g.values[y * width + x] = curve(scale * pixel.g);
      grids.b.values[y * width + x] = curve(scale * pixel.b);
    }
  return grids;
}

bool is_finite(const Frame& frame) {
  return std::ranges::all_of(frame.pixels, [](const Rgba& pixel) {
    return std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b);
  });
}

}  // namespace

double FlipErrors::mean() const {
  double sum = 0;
  for (const float error : errors) sum += double{error};
  return errors.empty() ? 0 : sum / static_cast<double>(errors.size());
}

ExposureRange flip_exposures(const Frame& reference) {
  std::vector<float> luminance;
  luminance.reserve(reference.pixels.size());
  for (const Rgba& pixel : reference.pixels)
    luminance.push_back(0.2126F * pixel.r + 0.7152F * pixel.g + 0.0722F * pixel.b);
  const float brightest = *std::ranges::max_element(luminance);
  if (!(brightest > 0)) return {};
  const auto middle = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() / 2);
  std::ranges::nth_element(luminance, middle);
  double median = double{*middle};
  if (luminance.size() % 2 == 0) median = 0.5 * (median + double{*std::max_element(luminance.begin(), middle)});
  const double darkest = std::min(double{std::numeric_limits<float>::epsilon()}, double{brightest});
  const double mapped = ToneCurve().inverse(0.85);
  ExposureRange range{std::log2(mapped / double{brightest}), std::log2(mapped / std::max(median, darkest)), 0};
  range.count = std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
  return range;
}

std::optional<FlipErrors> hdr_flip(const Frame& reference, const Frame& test) {
  require(reference.width == test.width && reference.height == test.height && !reference.pixels.empty(),
          "frames of one size are compared");
  if (!is_finite(reference) || !is_finite(test)) return std::nullopt;
  FlipErrors result{flip_exposures(reference), std::vector<float>(reference.pixels.size())};
  const ExposureRange& range = result.exposures;
  const FlipFilters filters = flip_filters();
  const std::vector<Square> all = squares(reference);
  parallel_for(all.size(), [&](std::size_t i) {
    const Square& square = all[i];
    if (!sees_difference(reference, test, square)) return;
    for (int step = 0; step < range.count; ++step) {
      const double exposure = range.start + step * (range.stop - range.start) / (range.count - 1);
      const std::vector<float> errors =
          ldr_flip(exposed(reference, square, exposure), exposed(test, square, exposure), filters);
      const float* error = errors.data();
      for (std::size_t y = square.y0; y < square.y1; ++y)
        for (std::size_t x = square.x0; x < square.x1; ++x, ++error) {
          float& largest = result.errors[y * reference.width + x];
          largest = std::max(largest, *error);
        }
    }
  });
  return result;
}

}  // namespace relook
