#include "light/light_shape.h"

#include <limits>

namespace relook {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// As a density: 0 where floats have none.
float density_of(double x) {
  const auto density = static_cast<float>(x);
  return density > 0 && density < kInfinity ? density : 0.0F;
}

std::optional<LightPoint> if_any(const LightPoint& point) {
  return point.density > 0 ? std::optional(point) : std::nullopt;
}

/// Where a ray meets a sphere around the origin, in metres; the nearest point to it if it just misses. `from` is
/// outside if it is farther away than the radius.
struct SphereCrossing {
  bool hits;
  double distance;
};
SphereCrossing cross_sphere(const Wide& from, double radius, const Wide& way) {
  const double scale = 1 / length_of(way), along = -from.dot(way) * scale;
  const Wide nearest = from + way * (along * scale);  // does not cancel as along^2 - from^2 does
  const double left = radius * radius - nearest.dot(nearest);
  const double half_chord = std::sqrt(left > 0 ? left : 0.0);
  const double outside = from.dot(from) - radius * radius;
  if (!(outside > 0)) return {true, along < 0 ? -outside / (half_chord - along) : along + half_chord};
  return {left >= 0 && along > 0, along > 0 ? outside / (along + half_chord) : 0.0};
}

/// Of the cone that a sphere fills; 2, for all directions, from inside.
double sphere_versine(const Wide& to_center, double radius) {
  const double distance2 = to_center.dot(to_center), radius2 = radius * radius;
  if (!(distance2 > radius2)) return 2;
  const double sine2 = radius2 / distance2;
  return sine2 / (1 + std::sqrt(1 - sine2));
}

}  // namespace

std::optional<LightPoint> SphereShape::sample(const Point& from, const Uv& u) const {
  const Wide to_center = wide(center_) - wide(from);
  const double versine = sphere_versine(to_center, radius_);
  const Wide axis = versine < 2 ? divided(to_center, length_of(to_center)) : Wide(0, 0, 1);
  const Direction way = narrow(cone_direction(shape_frame_around(axis), versine, u));
  const SphereCrossing crossing = cross_sphere(-to_center, radius_, wide(way));
  return if_any({way, static_cast<float>(crossing.distance), density(from, way)});
}

float SphereShape::density(const Point& from, const Direction& /*way*/) const {
  if (!(radius_ > 0)) return 0;
  return density_of(cone_density(sphere_versine(wide(center_) - wide(from), radius_)));
}

std::optional<float> SphereShape::cross(const Point& origin, const Direction& way) const {
  const SphereCrossing crossing = cross_sphere(wide(origin) - wide(center_), radius_, wide(way));
  if (!(radius_ > 0) || !crossing.hits) return std::nullopt;
  return static_cast<float>(crossing.distance);
}

Patch::Patch(const Point& origin, const Direction& x, const Direction& y) : origin_(origin), x_(wide(x)), y_(wide(y)) {
  const Wide both = x_.cross(y_);
  area_ = length_of(both);
  normal_ = divided(both, area_);
  to_x_ = divided(y_.cross(normal_), area_);
  to_y_ = divided(normal_.cross(x_), area_);
}

Wide Patch::way_to(const PlanePoint& point, const Point& from) const {
  return (wide(origin_) - wide(from)) + x_ * point.x + y_ * point.y;
}

float Patch::density(const Point& from, const Direction& way, double area, Sides sides) const {
  const double above = height(from), side = sides == Sides::both && above < 0 ? -1.0 : 1.0;
  const double cosine = -side * normal_.dot(wide(way));
  if (!(above * side > 0) || !(cosine > 0)) return 0;
  // distance^2 / (area cosine), with distance = height / cosine.
  return density_of(above * above / (area * cosine * cosine * cosine));
}

std::optional<Patch::Crossing> Patch::cross(const Point& from, const Direction& way, Sides sides) const {
  const double above = height(from), side = sides == Sides::both && above < 0 ? -1.0 : 1.0;
  const double cosine = -side * normal_.dot(wide(way));
  if (!(above * side > 0) || !(cosine > 0)) return std::nullopt;
  const double distance = above * side / cosine;
  const Wide at = (wide(from) - wide(origin_)) + wide(way) * distance;
  return Crossing{{to_x_.dot(at), to_y_.dot(at)}, static_cast<float>(distance)};
}

namespace {

/// A sample at the end of a way; none if it has no length or no density.
template <class Density>
std::optional<LightPoint> at_end(const Wide& way, const Density& density) {
  const double distance = length_of(way);
  const Direction direction = narrow(divided(way, distance));
  return if_any({direction, static_cast<float>(distance), density(direction)});
}

}  // namespace

RectShape::RectShape(const Point& center, const Direction& half_x, const Direction& half_y)
    : center_(center),
      patch_(center, half_x, half_y),
      width_(length_of(wide(half_x))),
      height_(length_of(wide(half_y))) {
  axis_x_ = divided(wide(half_x), width_);
  axis_y_ = patch_.normal().cross(axis_x_);
  is_right_angled_ = std::fabs(wide(half_x).dot(wide(half_y))) <= 1e-6 * width_ * height_;
}

SphericalRect RectShape::seen_from(const Point& from) const {
  const Wide to_center = wide(center_) - wide(from);
  const double x = axis_x_.dot(to_center), y = axis_y_.dot(to_center);
  return {x - width_, x + width_, y - height_, y + height_, is_right_angled_ ? patch_.height(from) : 0.0};
}

std::optional<LightPoint> RectShape::sample(const Point& from, const Uv& u) const {
  const SphericalRect seen = seen_from(from);
  const auto density_along = [&](const Direction& way) { return density(seen, from, way); };
  if (!seen.is_regular()) return at_end(patch_.way_to({2.0 * u.x - 1, 2.0 * u.y - 1}, from), density_along);
  const PlanePoint at = seen.point(u);
  return at_end(axis_x_ * at.x + axis_y_ * at.y - patch_.normal() * seen.height(), density_along);
}

float RectShape::density(const Point& from, const Direction& way) const { return density(seen_from(from), from, way); }

float RectShape::density(const SphericalRect& seen, const Point& from, const Direction& way) const {
  if (!seen.is_regular()) return patch_.density(from, way, 4 * patch_.area(), Sides::front);
  return patch_.normal().dot(wide(way)) < 0 ? density_of(1 / seen.solid_angle()) : 0.0F;
}

std::optional<float> RectShape::cross(const Point& origin, const Direction& way) const {
  const std::optional<Patch::Crossing> crossing = patch_.cross(origin, way, Sides::front);
  if (!crossing || !(std::fabs(crossing->at.x) <= 1) || !(std::fabs(crossing->at.y) <= 1)) return std::nullopt;
  return crossing->distance;
}

std::optional<LightPoint> DiskShape::sample(const Point& from, const Uv& u) const {
  return at_end(patch_.way_to(disc_point(u), from), [&](const Direction& way) { return density(from, way); });
}

float DiskShape::density(const Point& from, const Direction& way) const {
  return patch_.density(from, way, area(), Sides::front);
}

std::optional<float> DiskShape::cross(const Point& origin, const Direction& way) const {
  const std::optional<Patch::Crossing> crossing = patch_.cross(origin, way, Sides::front);
  if (!crossing || !(square(crossing->at.x) + square(crossing->at.y) <= 1)) return std::nullopt;
  return crossing->distance;
}

std::optional<LightPoint> TriangleShape::sample(const Point& from, const Uv& u) const {
  return at_end(patch_.way_to(triangle_point(u), from), [&](const Direction& way) { return density(from, way); });
}

float TriangleShape::density(const Point& from, const Direction& way) const {
  return patch_.density(from, way, area(), sides_);
}

std::optional<float> TriangleShape::cross(const Point& origin, const Direction& way) const {
  const std::optional<Patch::Crossing> crossing = patch_.cross(origin, way, sides_);
  if (!crossing || !(crossing->at.x >= 0) || !(crossing->at.y >= 0) || !(crossing->at.x + crossing->at.y <= 1))
    return std::nullopt;
  return crossing->distance;
}

SkyDisc::SkyDisc(const Direction& axis, float versine)
    : frame_(shape_frame_around(divided(wide(axis), length_of(wide(axis))))), versine_(versine) {}

std::optional<LightPoint> SkyDisc::sample(const Point& from, const Uv& u) const {
  const Direction way = narrow(cone_direction(frame_, versine_, u));
  return if_any({way, kInfinity, density(from, way)});
}

float SkyDisc::density(const Point& /*from*/, const Direction& /*way*/) const {
  return versine_ > 0 ? density_of(cone_density(versine_)) : 0.0F;
}

std::optional<float> SkyDisc::cross(const Point& /*origin*/, const Direction& way) const {
  const Wide apart = wide(way) - frame_.z;  // of unit vectors: its square is twice the versine, without cancelling
  if (!(versine_ > 0) || !(apart.dot(apart) <= 2.0 * versine_)) return std::nullopt;
  return kInfinity;
}

}  // namespace relook
