#include "light/light_math.h"

namespace relook {

PlanePoint disc_point(const Uv& u) {
  const double a = 2.0 * u.x - 1, b = 2.0 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr double kEighth = std::numbers::pi / 4;  // of a turn
  if (std::fabs(a) > std::fabs(b)) {
    const auto [sin, cos] = portable_sin_cos(kEighth * (b / a));
    return {a * cos, a * sin};
  }
  const auto [sin, cos] = portable_sin_cos(kEighth * (a / b));
  return {b * sin, b * cos};
}

PlanePoint triangle_point(const Uv& u) {
  const double a = u.x, b = u.y;
  return b > a ? PlanePoint{a / 2, b - a / 2} : PlanePoint{a - b / 2, b / 2};
}

Wide cone_direction(const ShapeFrame& frame, double versine, const Uv& u) {
  const PlanePoint at = disc_point(u);
  const double v = versine * (at.x * at.x + at.y * at.y);  // uniform in [0, versine)
  const double sine = std::sqrt(versine * (2 - v));        // over the disc's radius
  return frame.x * (at.x * sine) + frame.y * (at.y * sine) + frame.z * (1 - v);
}

}  // namespace relook
