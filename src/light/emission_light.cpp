#include "light/emission_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "light/luminance.h"

namespace relook {
namespace {

/// The share of the choice that goes by area alone.
constexpr double kByArea = 0.1;

struct Side {
  double area = 0;  // 0 for what cannot be sampled
  Normal normal{0, 0, 0};
};

Side side_of(const std::array<Point, 3>& at) {
  const Imath::V3d a(at[0]), b(at[1]), c(at[2]);
  const Imath::V3d normal = (b - a).cross(c - a);
  const double length = std::sqrt(normal.dot(normal));
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {length * 0.5, Normal(normal / length)};
}

/// The triangle's point for one of the unit square, by its two sums (Heitz 2019, A Low-Distortion Map Between Triangle
/// and Square): weights of the second and the third corner.
std::array<float, 2> in_triangle(double x, double y) {
  if (y > x) {
    x *= 0.5;
    y -= x;
  } else {
    y *= 0.5;
    x -= y;
  }
  return {static_cast<float>(x), static_cast<float>(y)};
}

}  // namespace

EmissionLight::EmissionLight(std::vector<EmissionTriangle> triangles) : triangles_(std::move(triangles)) {
  const std::size_t n = triangles_.size();
  std::vector<double> areas(n), weights(n);
  facets_.resize(n);
  double area = 0, light = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Side side = side_of(triangles_[i].at);
    const float mean = triangles_[i].mean;
    facets_[i].normal = side.normal;
    areas[i] = side.area;
    weights[i] = mean > 0 && std::isfinite(mean) ? side.area * static_cast<double>(mean) : 0.0;
    area += areas[i];
    light += weights[i];
  }
  if (!(area > 0)) return;
  for (std::size_t i = 0; i < n; ++i)
    weights[i] = light > 0 ? (1 - kByArea) * weights[i] / light + kByArea * areas[i] / area : areas[i] / area;
  choice_ = DiscreteDistribution(weights);
  for (std::size_t i = 0; i < n; ++i)
    if (areas[i] > 0) facets_[i].per_area = static_cast<float>(weights[i] / choice_.total() / areas[i]);
}

std::optional<EmissionLight::Emitter> EmissionLight::sample(const Point& from, Uv u) const {
  if (choice_.empty()) return std::nullopt;
  // Below its own last bit the first number goes on with low bits of the second, or triangles of less than 2^-24 would
  // be missed.
  const double x = static_cast<double>(u.x), y = static_cast<double>(u.y), fine = y * 0x1p12;
  const DiscreteDistribution::Choice choice = choice_.choose(x + (fine - std::floor(fine)) * 0x1p-24);
  const std::array<Point, 3>& at = triangles_[choice.index].at;
  const auto [b1, b2] = in_triangle(choice.rest, y);
  Emitter emitter{choice.index, b1, b2, at[0] + (at[1] - at[0]) * b1 + (at[2] - at[0]) * b2, {}, 0, 0};
  const Direction to = emitter.at - from;
  emitter.distance = std::sqrt(to.dot(to));
  if (!(emitter.distance > 0)) return std::nullopt;
  emitter.way = to / emitter.distance;
  emitter.density = density(choice.index, from, emitter.way, emitter.distance);
  if (!(emitter.density > 0)) return std::nullopt;
  return emitter;
}

float EmissionLight::density(std::uint32_t triangle, const Point&, const Direction& way, float distance) const {
  const Facet& facet = facets_[triangle];
  const float facing = -facet.normal.dot(way);
  const float cosine = triangles_[triangle].two_sided ? std::fabs(facing) : facing;
  if (!(cosine > 0)) return 0;
  const float density = facet.per_area * (distance * distance) / cosine;
  return std::isfinite(density) ? density : 0.0F;
}

float mean_luminance(const TexturePyramid& pyramid, const std::array<Uv, 3>& uv, const TextureSampler& sampler) {
  const TexturePyramid::Level& full = pyramid.levels[0];
  const Uv size(static_cast<float>(full.width), static_cast<float>(full.height));
  const std::array<Uv, 3> edges{(uv[1] - uv[0]) * size, (uv[2] - uv[1]) * size, (uv[0] - uv[2]) * size};  // texels
  // A quarter's area; of long triangles at least an eighth of the longest side, squared.
  float longest = 0;
  for (const Uv& edge : edges) longest = std::max(longest, edge.dot(edge));
  const float quarter = std::fabs(edges[0].cross(edges[2])) * 0.125F;
  const float level = 0.5F * portable_log2(std::max(std::max(quarter, longest * 0x1p-6F), 1.0F));
  const auto lookup = [&](float b0, float b1, float b2) {
    const Rgba texel = sample(pyramid, uv[0] * b0 + uv[1] * b1 + uv[2] * b2, level, {sampler.wrap_s, sampler.wrap_t});
    return std::max(luminance(Color(texel.r, texel.g, texel.b)), 0.0F);
  };
  constexpr float kThird = 1.0F / 3, kSixth = 1.0F / 6;
  return (lookup(kThird, kThird, kThird) + lookup(4 * kSixth, kSixth, kSixth) + lookup(kSixth, 4 * kSixth, kSixth) +
          lookup(kSixth, kSixth, 4 * kSixth)) *
         0.25F;
}

}  // namespace relook
