#include "compare/similarity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "compare/grid.h"

namespace relook {
namespace {

constexpr std::size_t kWindow = 11;
using Window = std::array<float, kWindow>;

Window gaussian_window() {
  constexpr double kDeviation = 1.5;
  std::array<double, kWindow> weights{};
  double sum = 0;
  for (std::size_t i = 0; i < kWindow; ++i) {
    const double x = static_cast<double>(i) - double{kWindow / 2};
    sum += weights[i] = std::exp(-x * x / (2 * kDeviation * kDeviation));
  }
  Window window;
  for (std::size_t i = 0; i < kWindow; ++i) window[i] = static_cast<float>(weights[i] / sum);
  return window;
}

float srgb(float linear) {
  if (!(linear > 0)) return 0;  // NaN, too
  if (linear >= 1) return 1;
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

Grid luma(const Frame& frame) {
  Grid grid(frame.width, frame.height);
  for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
    const Rgba& pixel = frame.pixels[i];
    grid.values[i] = 0.2126F * srgb(pixel.r) + 0.7152F * srgb(pixel.g) + 0.0722F * srgb(pixel.b);
  }
  return grid;
}

Grid product(const Grid& a, const Grid& b) {
  Grid result(a.width, a.height);
  for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] = a.values[i] * b.values[i];
  return result;
}

}  // namespace

std::optional<double> psnr(const FrameDifference& difference, DisplayWhite white) {
  if (!std::isfinite(difference.rms_error) || difference.rms_error == 0) return std::nullopt;
  return 20 * std::log10(white.value / difference.rms_error);
}

std::optional<double> ssim(const Frame& a, const Frame& b) {
  require(a.width == b.width && a.height == b.height, "frames of one size are compared");
  if (a.width < kWindow || a.height < kWindow) return std::nullopt;
  const Window window = gaussian_window();
  const auto mean = [&](const Grid& grid) { return filter_columns(filter_rows(grid, window), window); };
  const Grid x = luma(a), y = luma(b);
  const Grid mean_x = mean(x), mean_y = mean(y);
  const Grid mean_xx = mean(product(x, x)), mean_yy = mean(product(y, y)), mean_xy = mean(product(x, y));
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  double sum = 0;
  for (std::size_t i = 0; i < mean_x.values.size(); ++i) {
    const double mx = double{mean_x.values[i]}, my = double{mean_y.values[i]};
    const double variance_x = double{mean_xx.values[i]} - mx * mx, variance_y = double{mean_yy.values[i]} - my * my;
    const double covariance = double{mean_xy.values[i]} - mx * my;
    sum += (2 * mx * my + kC1) * (2 * covariance + kC2) / ((mx * mx + my * my + kC1) * (variance_x + variance_y + kC2));
  }
  return sum / static_cast<double>(mean_x.values.size());
}

}  // namespace relook
