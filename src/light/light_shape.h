// Shapes of lights with a size, in the world; points count from the camera's eye. Each shape has three functions:
//   sample   a point on the part that shines towards a place, for a point of the unit square
//   density  with which sample() takes a direction that crosses the shape
//   cross    where a ray meets a side that shines
// The density is a function of place and direction alone, the same bits from a sample and from a ray that happens to
// cross, so that the two can be weighted against each other. A shape of size zero has no samples. Nothing is NaN.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <variant>

#include "base/math.h"
#include "light/light_math.h"
#include "light/spherical_rect.h"

namespace relook {

struct LightPoint {
  Direction direction;  // unit, from the place to the point
  float distance;       // metres; infinity in the sky
  float density;        // per steradian, positive and finite
};

/// Whether what reaches up to `height` above a horizon, in metres, and is no farther away than three times `farthest`,
/// is below it by more than floats round a direction.
[[nodiscard]] inline bool is_surely_below(double height, double farthest) { return height < -1e-5 * farthest; }
[[nodiscard]] inline double largest_of(const Wide& v) {
  return std::max(std::max(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
}

/// Shines outwards and, for places inside, inwards. Sampled uniformly over the cone that it fills; from inside, over
/// all directions.
class SphereShape {
 public:
  SphereShape(const Point& center, float radius) : center_(center), radius_(radius) {}
  [[nodiscard]] bool shines_at(const Point& /*from*/) const { return true; }
  [[nodiscard]] bool is_below(const Point& from, const Direction& normal) const {
    const Wide to = wide(center_) - wide(from);
    return is_surely_below(to.dot(wide(normal)) + static_cast<double>(radius_), largest_of(to) + static_cast<double>(radius_));
  }
  [[nodiscard]] std::optional<LightPoint> sample(const Point& from, const Uv& u) const;
  [[nodiscard]] float density(const Point& from, const Direction& way) const;
  [[nodiscard]] std::optional<float> cross(const Point& origin, const Direction& way) const;

 private:
  Point center_;
  float radius_;
};

enum class Sides : std::uint8_t { front, both };

/// What flat shapes share: points origin + a x + b y, the plane's front, where x and y turn anticlockwise, and
/// densities of samples that are uniform over an area.
class Patch {
 public:
  Patch(const Point& origin, const Direction& x, const Direction& y);

  /// Unit; zero where x and y span no plane.
  [[nodiscard]] const Wide& normal() const { return normal_; }
  /// Of the parallelogram of x and y, in square metres.
  [[nodiscard]] double area() const { return area_; }
  /// From a place to a point.
  [[nodiscard]] Wide way_to(const PlanePoint& point, const Point& from) const;
  /// Of a place, in metres; negative behind the plane.
  [[nodiscard]] double height(const Point& from) const { return normal_.dot(wide(from) - wide(origin_)); }
  /// Are all its points with coordinates in [-1, 1] below the horizon of a place?
  [[nodiscard]] bool is_below(const Point& from, const Direction& normal) const {
    const Wide to = wide(origin_) - wide(from), up = wide(normal);
    return is_surely_below(to.dot(up) + std::fabs(x_.dot(up)) + std::fabs(y_.dot(up)),
                           largest_of(to) + largest_of(x_) + largest_of(y_));
  }
  /// 0 for directions that do not meet a side that shines.
  [[nodiscard]] float density(const Point& from, const Direction& way, double area, Sides sides) const;

  struct Crossing {
    PlanePoint at;
    float distance;
  };
  [[nodiscard]] std::optional<Crossing> cross(const Point& from, const Direction& way, Sides sides) const;

 private:
  Point origin_;
  Wide x_, y_, normal_;
  Wide to_x_, to_y_;  // whose products with a point of the plane, from the origin, are its coordinates
  double area_;
};

/// Points center + a half_x + b half_y for a and b in [-1, 1]; shines to the side of half_x cross half_y. Sampled
/// uniformly over its solid angle; over its area where that is tiny, from places next to its plane, and where its
/// corners are not right.
class RectShape {
 public:
  RectShape(const Point& center, const Direction& half_x, const Direction& half_y);
  [[nodiscard]] bool shines_at(const Point& from) const { return patch_.height(from) > 0; }
  [[nodiscard]] bool is_below(const Point& from, const Direction& normal) const { return patch_.is_below(from, normal); }
  [[nodiscard]] Direction normal() const { return narrow(patch_.normal()); }
  [[nodiscard]] std::optional<LightPoint> sample(const Point& from, const Uv& u) const;
  [[nodiscard]] float density(const Point& from, const Direction& way) const;
  [[nodiscard]] std::optional<float> cross(const Point& origin, const Direction& way) const;

 private:
  [[nodiscard]] SphericalRect seen_from(const Point& from) const;
  [[nodiscard]] float density(const SphericalRect& seen, const Point& from, const Direction& way) const;

  Point center_;
  Patch patch_;
  Wide axis_x_, axis_y_;   // unit, at right angles
  double width_, height_;  // half of them, in metres
  bool is_right_angled_;
};

/// An ellipse: points center + a half_x + b half_y for a^2 + b^2 <= 1; shines to the side of half_x cross half_y.
/// Sampled uniformly over its area.
class DiskShape {
 public:
  DiskShape(const Point& center, const Direction& half_x, const Direction& half_y) : patch_(center, half_x, half_y) {}
  [[nodiscard]] bool shines_at(const Point& from) const { return patch_.height(from) > 0; }
  [[nodiscard]] bool is_below(const Point& from, const Direction& normal) const { return patch_.is_below(from, normal); }
  [[nodiscard]] Direction normal() const { return narrow(patch_.normal()); }
  [[nodiscard]] std::optional<LightPoint> sample(const Point& from, const Uv& u) const;
  [[nodiscard]] float density(const Point& from, const Direction& way) const;
  [[nodiscard]] std::optional<float> cross(const Point& origin, const Direction& way) const;

 private:
  [[nodiscard]] double area() const { return std::numbers::pi * patch_.area(); }
  Patch patch_;
};

/// A triangle of an emitting mesh, anticlockwise from its front. Sampled uniformly over its area: at triangle_point(u),
/// the weights of its second and third corner.
class TriangleShape {
 public:
  TriangleShape(const Point& a, const Point& b, const Point& c, Sides sides) : patch_(a, b - a, c - a), sides_(sides) {}
  [[nodiscard]] bool shines_at(const Point& from) const { return sides_ == Sides::both || patch_.height(from) > 0; }
  [[nodiscard]] bool is_below(const Point& from, const Direction& normal) const { return patch_.is_below(from, normal); }
  [[nodiscard]] Direction normal() const { return narrow(patch_.normal()); }
  [[nodiscard]] double area() const { return 0.5 * patch_.area(); }
  [[nodiscard]] std::optional<LightPoint> sample(const Point& from, const Uv& u) const;
  [[nodiscard]] float density(const Point& from, const Direction& way) const;
  [[nodiscard]] std::optional<float> cross(const Point& origin, const Direction& way) const;

 private:
  Patch patch_;
  Sides sides_;
};

/// A round part of the sky, infinitely far away: directions within an angle from the axis, which points to the light.
/// Sampled uniformly over its solid angle. `versine`: of that angle (versine_of), up to 2.
class SkyDisc {
 public:
  SkyDisc(const Direction& axis, float versine);
  [[nodiscard]] bool shines_at(const Point& /*from*/) const { return true; }
  [[nodiscard]] bool is_below(const Point& /*from*/, const Direction& /*normal*/) const { return false; }
  [[nodiscard]] std::optional<LightPoint> sample(const Point& from, const Uv& u) const;
  [[nodiscard]] float density(const Point& from, const Direction& way) const;
  [[nodiscard]] std::optional<float> cross(const Point& origin, const Direction& way) const;

 private:
  ShapeFrame frame_;
  float versine_;
};

using LightShape = std::variant<SphereShape, RectShape, DiskShape, TriangleShape, SkyDisc>;

/// False: sample() has none for this place.
[[nodiscard]] inline bool shines_at(const LightShape& shape, const Point& from) {
  return std::visit([&](const auto& any) { return any.shines_at(from); }, shape);
}
/// True: no direction to a sample has a cosine above 0 with the normal, which is of length 1, in floats either.
[[nodiscard]] inline bool is_below(const LightShape& shape, const Point& from, const Direction& normal) {
  return std::visit([&](const auto& any) { return any.is_below(from, normal); }, shape);
}

/// None: the place sees no side that shines, or the shape has no size.
[[nodiscard]] inline std::optional<LightPoint> sample(const LightShape& shape, const Point& from, const Uv& u) {
  return std::visit([&](const auto& any) { return any.sample(from, u); }, shape);
}
/// Per steradian, for a unit direction that crosses the shape; 0 where sample() has none.
[[nodiscard]] inline float density(const LightShape& shape, const Point& from, const Direction& way) {
  return std::visit([&](const auto& any) { return any.density(from, way); }, shape);
}
/// Metres along a unit direction to the first side that shines at the origin.
[[nodiscard]] inline std::optional<float> cross(const LightShape& shape, const Point& origin, const Direction& way) {
  return std::visit([&](const auto& any) { return any.cross(origin, way); }, shape);
}

}  // namespace relook
