// A rectangle as it is seen from a place: its solid angle, and points that are uniform over that (Ureña et al. 2013,
// "An Area-Preserving Parametrization for Spherical Rectangles"). Their sum of four angles is taken as the argument of
// a product of four complex numbers, which loses nothing for small rectangles.
#pragma once
#include "light/light_math.h"

namespace relook {

/// The rectangle [x0, x1] x [y0, y1] of a plane, from a place above its origin.
class SphericalRect {
 public:
  SphericalRect(double x0, double x1, double y0, double y1, double height);

  /// Whether the other functions may be asked: the place is well in front of the plane and sees something of it.
  [[nodiscard]] bool is_regular() const { return is_regular_; }
  [[nodiscard]] double height() const { return z_; }
  /// Steradians.
  [[nodiscard]] double solid_angle() const { return solid_angle_; }
  [[nodiscard]] PlanePoint point(const Uv& u) const;

 private:
  double x0_, x1_, y0_, y1_, z_;
  bool is_regular_ = false;
  double solid_angle_ = 0;
  double left_cosine_ = 1, left_sine_ = 0;  // of the signed solid angle of [0, x0] x [y0, y1]
};

}  // namespace relook
