#include "path_reference_light.h"

#include <algorithm>
#include <cmath>

#include "pi.h"

namespace relook {

Vec radiance_of(const Light& light) {
  double scale = light.intensity;
  if (light.radius > 0) scale /= kPi * light.radius * light.radius;
  if (light.angle > 0) scale /= kPi * std::pow(std::sin(light.angle / 2.0), 2);
  return color_of(light.color) * scale;
}

bool has_shape(const Light& light) { return light.radius > 0 || light.angle > 0 || traits_of(light.kind).has_size; }

double share_of(const Light& light, const Vec& at) {
  if (!traits_of(light.kind).has_radius) return 1;
  const Vec way = Vec(light.position) - at;
  const double window = std::max(1 - std::pow(way.length() / light.range, 4), 0.0);
  if (!traits_of(light.kind).has_cone) return window;
  const double outer = std::cos(double{light.outer_cone}), inner = std::cos(double{light.inner_cone});
  const double cosine = -Vec(light.direction).dot(way.normalized());
  return window * std::pow(std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0), 2);
}

std::optional<double> crossing(const Light& light, const Vec& origin, const Vec& way) {
  if (light.angle > 0)
    return -Vec(light.direction).dot(way) >= std::cos(light.angle / 2.0) ? std::optional(1e30) : std::nullopt;
  const Vec to = Vec(light.position) - origin;
  if (light.radius > 0) {
    const double along = to.dot(way), left = double{light.radius} * light.radius - (to - way * along).length2();
    if (left < 0) return std::nullopt;
    const double half = std::sqrt(left), t = to.length() > light.radius ? along - half : along + half;
    return t > 0 ? std::optional(t) : std::nullopt;
  }
  const double facing = Vec(light.direction).dot(way);
  if (facing >= 0) return std::nullopt;
  const double t = Vec(light.direction).dot(to) / facing;
  const Vec at = way * t - to, right(light.right), up(light.up);
  const double x = at.dot(right) / right.length2(), y = at.dot(up) / up.length2();
  const bool is_inside = light.kind == LightKind::disk ? x * x + y * y <= 1 : std::max(std::fabs(x), std::fabs(y)) <= 1;
  return t > 0 && is_inside ? std::optional(t) : std::nullopt;
}

}  // namespace relook
