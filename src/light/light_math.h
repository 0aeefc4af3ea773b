// Geometry that shapes of lights share: frames, maps from the unit square that keep areas and so stratification, cones.
// In doubles: lights are small and far away, or close and large. Half angles of cones are given by their versine,
// 1 - cos, which does not cancel for narrow ones.
#pragma once
#include <cmath>
#include <numbers>

#include "base/math.h"
#include "base/portable_math.h"

namespace relook {

/// A point from another one, or a direction.
using Wide = Imath::V3d;

[[nodiscard]] inline Wide wide(const Direction& v) { return {v.x, v.y, v.z}; }
[[nodiscard]] inline Direction narrow(const Wide& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
[[nodiscard]] inline double square(double x) { return x * x; }
[[nodiscard]] inline double length_of(const Wide& v) { return std::sqrt(v.dot(v)); }
/// v / divisor; zero for a divisor of zero.
[[nodiscard]] inline Wide divided(const Wide& v, double divisor) {
  return divisor > 0 ? v * (1 / divisor) : Wide(0, 0, 0);
}

/// Right-handed, of unit vectors.
struct ShapeFrame {
  Wide x, y, z;
};
/// Around a unit vector (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
[[nodiscard]] inline ShapeFrame shape_frame_around(const Wide& z) {
  const double sign = z.z < 0 ? -1.0 : 1.0;
  const double a = -1 / (sign + z.z), b = z.x * z.y * a;
  return {{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}

/// Coordinates in a plane.
struct PlanePoint {
  double x, y;
};
/// Uniform in the unit disc for uniform u (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square").
[[nodiscard]] PlanePoint disc_point(const Uv& u);
/// The weights of a triangle's second and third corner, uniform over its area (Heitz 2019, "A Low-Distortion Map
/// Between Triangle and Square").
[[nodiscard]] PlanePoint triangle_point(const Uv& u);

/// Of an angle in radians, by libm: for values of a scene.
[[nodiscard]] inline float versine_of(float angle) {
  return static_cast<float>(2 * square(std::sin(0.5 * double{angle})));
}
/// Uniform in the cone around frame.z; a versine of 2 is all directions.
[[nodiscard]] Wide cone_direction(const ShapeFrame& frame, double versine, const Uv& u);
/// Per steradian.
[[nodiscard]] inline double cone_density(double versine) { return 0.5 * std::numbers::inv_pi / versine; }

}  // namespace relook
