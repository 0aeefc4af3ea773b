#include "compare/flip_ldr.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace relook {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * kPi / 180;
// Contrast sensitivity, Table 1: a1 sqrt(pi/b1) exp(-pi^2 x^2 / b1) + a2 ..., x in degrees.
constexpr double kAchromaticWidth = 0.0047, kRedGreenWidth = 0.0053;
constexpr double kWideAmount = 34.1, kWideWidth = 0.04, kNarrowAmount = 13.5, kNarrowWidth = 0.025;
constexpr double kFeatureWidth = 0.082;  // degrees from peak to trough, two standard deviations
constexpr float kColorExponent = 0.7F, kFeatureExponent = 0.5F;
constexpr float kBreakShare = 0.4F, kBreakError = 0.95F;  // of the largest colour distance; the error there

// sRGB primaries and D65, as fractions that make white's XYZ exact; the inverse is of these.
constexpr float ratio(double a, double b) { return static_cast<float>(a / b); }
constexpr float kToXyz[3][3] = {{ratio(10135552, 24577794), ratio(8788810, 24577794), ratio(4435075, 24577794)},
                                {ratio(2613072, 12288897), ratio(8788810, 12288897), ratio(887015, 12288897)},
                                {ratio(1425312, 73733382), ratio(8788810, 73733382), ratio(70074185, 73733382)}};
constexpr float kToRgb[3][3] = {{3.241003275F, -1.537398934F, -0.498615861F},
                                {-0.969224334F, 1.875930071F, 0.041554224F},
                                {0.055639423F, -0.204011202F, 1.057148933F}};
constexpr float kWhite[3] = {0.950428545F, 1.0F, 1.088900371F};

struct Triple {
  float x, y, z;
};

Triple product(const float (&matrix)[3][3], Triple v) {
  const auto row = [&](const float(&m)[3]) { return m[0] * v.x + m[1] * v.y + m[2] * v.z; };
  return {row(matrix[0]), row(matrix[1]), row(matrix[2])};
}

/// XYZ relative to white.
Triple relative_xyz(Triple rgb) {
  const Triple xyz = product(kToXyz, rgb);
  return {xyz.x / kWhite[0], xyz.y / kWhite[1], xyz.z / kWhite[2]};
}

/// Linearised CIELAB: Y, Cx, Cz.
Triple opponent(Triple rgb) {
  const Triple xyz = relative_xyz(rgb);
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Triple rgb_of_opponent(Triple color) {
  const float y = (color.x + 16) / 116;
  return product(kToRgb, {(y + color.y / 500) * kWhite[0], y * kWhite[1], (y - color.z / 200) * kWhite[2]});
}

/// CIELAB with chroma scaled by lightness (the Hunt effect).
Triple hunt_lab(Triple rgb) {
  constexpr float kDelta = 6.0F / 29;
  const auto root = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0F / 29;
  };
  const Triple xyz = relative_xyz(rgb);
  const float y = root(xyz.y), lightness = 116 * y - 16;
  return {lightness, 0.01F * lightness * 500 * (root(xyz.x) - y), 0.01F * lightness * 200 * (y - root(xyz.z))};
}

float length(float x, float y) { return std::sqrt(x * x + y * y); }

float hyab(Triple a, Triple b) { return std::abs(a.x - b.x) + length(a.y - b.y, a.z - b.z); }

/// HyAB distances to [0, 1]: linear up to the break, compressed beyond (4.2).
float color_error(float distance) {
  static const float largest =
      std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColorExponent);  // green to blue
  const float power = std::pow(distance, kColorExponent), at_break = kBreakShare * largest;
  if (power < at_break) return kBreakError / at_break * power;
  return kBreakError + (power - at_break) / (largest - at_break) * (1 - kBreakError);
}

FlipKernel gaussian(double width) {
  FlipKernel kernel;
  double sum = 0;
  std::array<double, std::tuple_size_v<FlipKernel>> weights{};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double degrees = (static_cast<double>(i) - double{kFlipRadius}) / kPixelsPerDegree;
    sum += weights[i] = std::exp(-kPi * kPi * degrees * degrees / width);
  }
  for (std::size_t i = 0; i < weights.size(); ++i) kernel[i] = static_cast<float>(weights[i] / sum);
  return kernel;
}

/// What a blue-yellow Gaussian adds to the sum of all weights of its square filter.
double weight_of(double amount, double width) {
  double sum = 0;
  for (std::size_t i = 0; i < std::tuple_size_v<FlipKernel>; ++i) {
    const double degrees = (static_cast<double>(i) - double{kFlipRadius}) / kPixelsPerDegree;
    sum += std::exp(-kPi * kPi * degrees * degrees / width);
  }
  return amount * std::sqrt(kPi / width) * sum * sum;
}

/// A derivative of a Gaussian: positive weights sum to 1, negative ones to -1; or the Gaussian, which sums to 1.
template <class Weight>
FlipKernel feature_kernel(const Weight& weight) {
  const double deviation = 0.5 * kFeatureWidth * kPixelsPerDegree;
  const double radius = std::ceil(3 * deviation);
  std::array<double, std::tuple_size_v<FlipKernel>> weights{};
  double positive = 0, negative = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double x = static_cast<double>(i) - double{kFlipRadius};
    if (std::abs(x) > radius) continue;
    weights[i] = weight(x, deviation) * std::exp(-x * x / (2 * deviation * deviation));
    (weights[i] > 0 ? positive : negative) += std::abs(weights[i]);
  }
  FlipKernel kernel{};
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] != 0) kernel[i] = static_cast<float>(weights[i] / (weights[i] > 0 ? positive : negative));
  return kernel;
}

struct OpponentGrids {
  Grid y, cx, cz;
};

OpponentGrids opponent_grids(const RgbGrids& image) {
  OpponentGrids grids{image.r, image.g, image.b};
  for (std::size_t i = 0; i < image.r.values.size(); ++i) {
    const Triple color = opponent({image.r.values[i], image.g.values[i], image.b.values[i]});
    grids.y.values[i] = color.x;
    grids.cx.values[i] = color.y;
    grids.cz.values[i] = color.z;
  }
  return grids;
}

Grid filtered(const Grid& grid, const FlipKernel& along_rows, const FlipKernel& along_columns) {
  return filter_columns(filter_rows(grid, along_rows), along_columns);
}

/// What the observer sees of the colours: filtered, back in the range of the display, perceptually uniform.
std::vector<Triple> seen_colors(const OpponentGrids& image, const FlipFilters& filters) {
  const Grid y = filtered(image.y, filters.achromatic, filters.achromatic);
  const Grid cx = filtered(image.cx, filters.red_green, filters.red_green);
  const Grid wide = filtered(image.cz, filters.blue_yellow_wide, filters.blue_yellow_wide);
  const Grid narrow = filtered(image.cz, filters.blue_yellow_narrow, filters.blue_yellow_narrow);
  std::vector<Triple> seen(y.values.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const float cz = filters.wide_share * wide.values[i] + filters.narrow_share * narrow.values[i];
    const Triple rgb = rgb_of_opponent({y.values[i], cx.values[i], cz});
    seen[i] = hunt_lab({std::clamp(rgb.x, 0.0F, 1.0F), std::clamp(rgb.y, 0.0F, 1.0F), std::clamp(rgb.z, 0.0F, 1.0F)});
  }
  return seen;
}

struct Features {
  std::vector<float> edges, points;  // magnitudes
};

Features features(Grid achromatic, const FlipFilters& filters) {
  for (float& value : achromatic.values) value = (value + 16) / 116;
  const Grid smooth = filter_rows(achromatic, filters.gaussian);
  const auto magnitudes = [&](const FlipKernel& derivative) {
    const Grid across = filtered(achromatic, derivative, filters.gaussian);
    const Grid down = filter_columns(smooth, derivative);
    std::vector<float> values(across.values.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = length(across.values[i], down.values[i]);
    return values;
  };
  return {magnitudes(filters.edge), magnitudes(filters.point)};
}

}  // namespace

FlipFilters flip_filters() {
  FlipFilters filters;
  filters.achromatic = gaussian(kAchromaticWidth);
  filters.red_green = gaussian(kRedGreenWidth);
  filters.blue_yellow_wide = gaussian(kWideWidth);
  filters.blue_yellow_narrow = gaussian(kNarrowWidth);
  const double wide = weight_of(kWideAmount, kWideWidth), narrow = weight_of(kNarrowAmount, kNarrowWidth);
  filters.wide_share = static_cast<float>(wide / (wide + narrow));
  filters.narrow_share = static_cast<float>(narrow / (wide + narrow));
  filters.gaussian = feature_kernel([](double, double) { return 1.0; });
  filters.edge = feature_kernel([](double x, double) { return -x; });
  filters.point = feature_kernel([](double x, double deviation) { return x * x / (deviation * deviation) - 1; });
  return filters;
}

std::vector<float> ldr_flip(const RgbGrids& reference, const RgbGrids& test, const FlipFilters& filters) {
  require(reference.r.width == test.r.width && reference.r.height == test.r.height, "images of one size are compared");
  const OpponentGrids a = opponent_grids(reference), b = opponent_grids(test);
  const std::vector<Triple> seen_a = seen_colors(a, filters), seen_b = seen_colors(b, filters);
  const Features features_a = features(a.y, filters), features_b = features(b.y, filters);
  std::vector<float> errors(seen_a.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const float feature = std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                                   std::abs(features_a.points[i] - features_b.points[i]));
    const float exponent = 1 - std::pow(feature / std::numbers::sqrt2_v<float>, kFeatureExponent);
    errors[i] = std::pow(color_error(hyab(seen_a[i], seen_b[i])), exponent);
  }
  return errors;
}

}  // namespace relook
