#include "light/environment_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "light/luminance.h"

namespace relook {
namespace {

constexpr TextureSampler kAround{Wrap::repeat, Wrap::clamp};
/// 2 pi^2: area of the unit square of uv in steradians where the sine of the polar angle is 1.
constexpr double kSteradiansOfUv = 19.739208802178716;
/// Least sine of a polar angle that a density is divided by: densities stay finite at the poles.
constexpr float kLeastSine = 0x1p-13F;

Color clamped(const Rgba& texel) {
  return {texel.r > 0 ? texel.r : 0.0F, texel.g > 0 ? texel.g : 0.0F, texel.b > 0 ? texel.b : 0.0F};
}

/// Sine of a direction's polar angle, as densities are divided by.
float clamped_sine(const Direction& way) {
  const float sine = std::sqrt(way.x * way.x + way.z * way.z);
  return sine > kLeastSine ? sine : kLeastSine;
}

/// Sine of the polar angle in the middle of a row of texels; the row's solid angle is proportional to it.
float row_sine(std::uint32_t row, std::uint32_t height) {
  const std::uint32_t from_pole = std::min(row, height - 1 - row);
  return portable_sin_turns((static_cast<float>(from_pole) + 0.5F) / static_cast<float>(height) * 0.5F);
}

/// What is to be known of the texels of level 0 once they are clamped.
struct TexelLight {
  std::vector<float> luminances;   // [height][width]
  double light = 0, negative = 0;  // sums of luminance times the row's sine
};

TexelLight texel_light(const TexturePyramid& image) {
  const auto [width, height, offset] = image.levels[0];
  constexpr TextureSampler kNearest{Wrap::repeat, Wrap::clamp, TexelFilter::nearest, TexelFilter::nearest};
  const auto texel = [&](std::uint32_t x, std::uint32_t y) {
    if (image.format == TexelFormat::float32) {
      const float* t = &image.texels32[(offset + std::uint64_t{y} * width + x) * 4];
      return Rgba(t[0], t[1], t[2], t[3]);
    }
    const Uv middle((static_cast<float>(x) + 0.5F) / static_cast<float>(width),
                    (static_cast<float>(y) + 0.5F) / static_cast<float>(height));
    return sample(image, middle, 0, kNearest);
  };
  TexelLight result;
  result.luminances.reserve(std::size_t{width} * height);
  for (std::uint32_t y = 0; y < height; ++y) {
    double light = 0, negative = 0;
    for (std::uint32_t x = 0; x < width; ++x) {
      const Rgba value = texel(x, y);
      const float l = luminance(clamped(value));
      light += static_cast<double>(l);
      negative += static_cast<double>(luminance(clamped(value * -1.0F)));
      result.luminances.push_back(l);
    }
    const auto sine = static_cast<double>(row_sine(y, height));
    result.light += light * sine;
    result.negative += negative * sine;
  }
  return result;
}

/// The largest t that is 4 x the solid-angle mean of min(L, t). f(t), four times that mean, is concave and consists of
/// straight pieces: 4 (A + t P), with A the mean of L where L <= t and P the share of the sphere where L > t. Plain
/// iteration t = f(t) converges as slowly as 4 P is near 1. Newton's method, t = 4 A / (1 - 4 P) of the piece at t,
/// goes down from 4 x the mean without passing the fixed point, and is there once a step stays on its piece: it ends. A
/// quarter of the sphere or more is never above a t that is larger than the fixed point.
double largest_fixed_point(const std::vector<float>& luminances, std::uint32_t width, std::uint32_t height,
                           double light) {
  double all = 0;
  for (std::uint32_t y = 0; y < height; ++y) all += static_cast<double>(row_sine(y, height)) * width;
  double t = 4 * light / all;
  while (true) {
    double below = 0, above = 0;
    for (std::uint32_t y = 0; y < height; ++y) {
      const float* row = &luminances[std::size_t{y} * width];
      double sum = 0, count = 0;
      for (std::uint32_t x = 0; x < width; ++x) {
        const auto l = static_cast<double>(row[x]);
        sum += l > t ? 0.0 : l;
        count += l > t ? 1.0 : 0.0;
      }
      const auto sine = static_cast<double>(row_sine(y, height));
      below += sum * sine;
      above += count * sine;
    }
    const double rest = all - 4 * above;
    const double next = rest > 0 ? 4 * below / rest : t;
    if (!(next < t)) return t;
    t = next;
  }
}

}  // namespace

Uv environment_uv(const Direction& way) {
  return {portable_atan2_turns(way.x, -way.z) + 0.5F, 0.5F - 2.0F * portable_asin_turns(way.y)};
}

Direction environment_way(double u, double v) {
  // From the nearer pole, where sines of small angles are exact.
  const auto polar = static_cast<float>(std::min(v, 1.0 - v) * 0.5), around = static_cast<float>(u - 0.5);
  const float sine = portable_sin_turns(polar), cosine = portable_cos_turns(polar);
  return {sine * portable_sin_turns(around), v > 0.5 ? -cosine : cosine, -(sine * portable_cos_turns(around))};
}

EnvironmentLight::EnvironmentLight(std::shared_ptr<const TexturePyramid> image) : image_(std::move(image)) {
  if (!image_) return;
  width_ = image_->levels[0].width;
  height_ = image_->levels[0].height;
  const TexelLight texels = texel_light(*image_);
  if (texels.negative > 0) negative_share_ = texels.negative / (texels.negative + texels.light);
  const auto t = static_cast<float>(largest_fixed_point(texels.luminances, width_, height_, texels.light));
  if (!(*std::max_element(texels.luminances.begin(), texels.luminances.end()) > t)) return;
  threshold_ = t;
  weigh_suns(texels.luminances);
  double suns = 0;
  for (std::uint32_t row = 0; row < rows_; ++row)
    for (std::uint32_t x = 0; x < width_; ++x) suns += static_cast<double>(weights_[std::size_t{row} * width_ + x]);
  sun_share_ = suns / texels.light;
  // Each texel weighs 1 / (width height) in the integral of the interpolation over uv.
  const double scale = static_cast<double>(width_) * height_ / (suns * kSteradiansOfUv);
  for (float& weight : weights_) weight = static_cast<float>(static_cast<double>(weight) * scale);
  suns_ = cells_of_suns();
}

void EnvironmentLight::weigh_suns(const std::vector<float>& luminances) {
  const auto shines = [t = threshold_](float l) { return l > t; };
  const auto width = static_cast<std::ptrdiff_t>(width_);
  const auto first = std::find_if(luminances.begin(), luminances.end(), shines) - luminances.begin();
  const auto behind = luminances.rend() - std::find_if(luminances.rbegin(), luminances.rend(), shines);
  first_row_ = static_cast<std::uint32_t>(first / width);
  rows_ = static_cast<std::uint32_t>((behind - 1) / width) + 1 - first_row_;
  weights_.reserve(std::size_t{rows_} * width_);
  for (std::uint32_t row = first_row_; row < first_row_ + rows_; ++row) {
    const float sine = row_sine(row, height_);
    for (std::uint32_t x = 0; x < width_; ++x) {
      const float l = luminances[std::size_t{row} * width_ + x];
      weights_.push_back(shines(l) ? (l - threshold_) * sine : 0.0F);
    }
  }
}

float EnvironmentLight::weight(std::uint32_t column, std::int64_t row) const {
  const auto last = static_cast<std::int64_t>(height_) - 1;
  const std::int64_t index = std::clamp<std::int64_t>(row, 0, last) - first_row_;
  if (index < 0 || index >= rows_) return 0;
  return weights_[static_cast<std::size_t>(index) * width_ + column];
}

GridDistribution EnvironmentLight::cells_of_suns() const {
  std::vector<GridDistribution::Cell> cells;
  for (std::uint32_t row = first_row_; row <= first_row_ + rows_; ++row) {
    const double area = row == 0 || row == height_ ? 0.5 : 1.0;
    for (std::uint32_t column = 0; column < width_; ++column) {
      const std::uint32_t left = (column == 0 ? width_ : column) - 1;
      const std::int64_t above = std::int64_t{row} - 1;
      const std::array<float, 4> corners{weight(left, above), weight(column, above), weight(left, above + 1),
                                         weight(column, above + 1)};
      double sum = 0;
      for (const float corner : corners) sum += static_cast<double>(corner);
      if (sum > 0) cells.push_back({row, column, sum * area, corners});
    }
  }
  return GridDistribution(cells);
}

EnvironmentLight::Parts EnvironmentLight::parts(const Direction& way) const {
  if (!image_) return {Color(1, 1, 1), Color(0, 0, 0)};
  const Color all = clamped(relook::sample(*image_, environment_uv(way), 0, kAround));
  const Color sky = all * sky_share(luminance(all), threshold_);
  return {sky, all - sky};
}

std::optional<EnvironmentLight::Sun> EnvironmentLight::sample(Uv u) const {
  std::optional<Sun> sun;
  sample({&u, 1}, {&sun, 1});
  return sun;
}

void EnvironmentLight::sample(std::span<const Uv> u, std::span<std::optional<Sun>> suns) const {
  std::ranges::fill(suns, std::nullopt);
  if (suns_.empty()) return;
  constexpr std::size_t kTogether = 16;
  std::array<GridDistribution::Search, kTogether> searches;
  for (std::size_t first = 0; first < u.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, u.size() - first);
    for (std::size_t k = 0; k < count; ++k)
      searches[k] = suns_.search(static_cast<double>(u[first + k].y), static_cast<double>(u[first + k].x));
    for (std::size_t k = 0; k < count; ++k) suns_.narrow(searches[k]);
    for (std::size_t k = 0; k < count; ++k) suns[first + k] = sun_in(suns_.found(searches[k]));
  }
}

std::optional<EnvironmentLight::Sun> EnvironmentLight::sun_in(const GridDistribution::Choice& cell) const {
  const auto corner = [&](std::size_t i) { return static_cast<double>(cell.corners[i]); };
  const double a = corner(0), b = corner(1), c = corner(2), d = corner(3);
  const double y = sample_linear(a + b, c + d, cell.rest_row);
  const double x = sample_linear(a + (c - a) * y, b + (d - b) * y, cell.rest_column);
  // Texels' middles stand at halves; a half cell at a pole begins or ends there.
  const double top = cell.row == 0 ? 0.0 : cell.row - 0.5, tall = cell.row == 0 || cell.row == height_ ? 0.5 : 1.0;
  const double along = (cell.column - 0.5 + x) / width_;
  Sun sun{environment_way(along < 0 ? along + 1 : along, (top + y * tall) / height_), 0};
  // As density() has it for this direction, but for the rounding of the way to texels and back. Next to a pole the way
  // does not tell x any more.
  const auto value = static_cast<float>((a + (c - a) * y) * (1 - x) + (b + (d - b) * y) * x);
  const float sine = clamped_sine(sun.way);
  sun.density = sine > kLeastSine ? value / sine : density(sun.way);
  if (!(sun.density > 0)) return std::nullopt;
  return sun;
}

float EnvironmentLight::density(const Direction& way) const {
  if (suns_.empty()) return 0;
  const float y = (0.5F - 2.0F * portable_asin_turns(way.y)) * static_cast<float>(height_) - 0.5F;
  const float y0 = std::floor(y);
  const auto row = static_cast<std::int64_t>(y0);
  if (row + 1 < first_row_ || row >= std::int64_t{first_row_} + rows_) return 0;
  const float x = environment_uv(way).x * static_cast<float>(width_) - 0.5F;
  const float x0 = std::floor(x);
  const auto left = static_cast<std::int64_t>(x0), width = static_cast<std::int64_t>(width_);
  const auto wrapped = [&](std::int64_t column) {
    return static_cast<std::uint32_t>(column < 0 ? column + width : (column >= width ? column - width : column));
  };
  const std::uint32_t l = wrapped(left), r = wrapped(left + 1);
  const float across = x - x0, down = y - y0;
  const float top = weight(l, row) * (1.0F - across) + weight(r, row) * across;
  const float bottom = weight(l, row + 1) * (1.0F - across) + weight(r, row + 1) * across;
  return (top * (1.0F - down) + bottom * down) / clamped_sine(way);
}

}  // namespace relook
