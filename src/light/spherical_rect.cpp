#include "light/spherical_rect.h"

#include <algorithm>

namespace relook {
namespace {

// In doubles the map is good to floats from these on.
constexpr double kLeastSolidAngle = 1e-6;  // steradians
constexpr double kLeastHeight = 1e-5;      // of the farthest coordinate

struct Complex {
  double re, im;
};
Complex operator*(const Complex& a, const Complex& b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
Complex conjugate(const Complex& a) { return {a.re, -a.im}; }
Complex unit_complex(const Complex& a) {
  const double scale = 1 / std::sqrt(a.re * a.re + a.im * a.im);
  return {a.re * scale, a.im * scale};
}

/// Its argument is the solid angle of [0, x] x [0, y], signed as x y is: atan(x y / (z r)).
Complex corner(double x, double y, double z) { return {z * std::sqrt(x * x + y * y + z * z), x * y}; }
/// Its argument, in (-pi, pi), is that of [0, x] x [y0, y1].
Complex strip(double x, double y0, double y1, double z) { return unit_complex(corner(x, y1, z) * conjugate(corner(x, y0, z))); }

}  // namespace

SphericalRect::SphericalRect(double x0, double x1, double y0, double y1, double height)
    : x0_(x0), x1_(x1), y0_(y0), y1_(y1), z_(height) {
  const double farthest = std::max({std::fabs(x0), std::fabs(x1), std::fabs(y0), std::fabs(y1)});
  if (!(z_ > kLeastHeight * farthest) || !(x1 > x0) || !(y1 > y0)) return;
  const Complex left = strip(x0, y0, y1, z_), all = strip(x1, y0, y1, z_) * conjugate(left);
  left_cosine_ = left.re;
  left_sine_ = left.im;
  solid_angle_ = portable_atan2(all.im, all.re);
  // More than half of the hemisphere is seen only from above the rectangle.
  if (solid_angle_ < 0 && x0 < 0 && x1 > 0 && y0 < 0 && y1 > 0) solid_angle_ += 2 * std::numbers::pi;
  is_regular_ = solid_angle_ >= kLeastSolidAngle;
}

PlanePoint SphericalRect::point(const Uv& u) const {
  // The x up to which the share u.x of the solid angle reaches: with phi the signed solid angle of [0, x] x [y0, y1]
  // and s0, s1 the sines of the elevations of the sides y0, y1, the sine of that of x has
  //   phi = asin(s s1) - asin(s s0), so s = sin phi / sqrt(s0^2 + s1^2 - 2 s0 s1 cos phi).
  const SinCos share = portable_sin_cos(u.x * solid_angle_);
  const Complex phi = Complex{left_cosine_, left_sine_} * Complex{share.cos, share.sin};
  const double s0 = y0_ / std::sqrt(y0_ * y0_ + z_ * z_), s1 = y1_ / std::sqrt(y1_ * y1_ + z_ * z_);
  const double rest = s0 * s0 + s1 * s1 - 2 * s0 * s1 * phi.re - phi.im * phi.im;
  const double x = rest > 0 ? std::clamp(z_ * phi.im / std::sqrt(rest), x0_, x1_) : (phi.im > 0 ? x1_ : x0_);
  // On the line of that x the sine of the elevation of y is uniform.
  const double r2 = x * x + z_ * z_;
  const double h0 = y0_ / std::sqrt(r2 + y0_ * y0_), h1 = y1_ / std::sqrt(r2 + y1_ * y1_);
  const double h = h0 + u.y * (h1 - h0), cosine2 = (1 - h) * (1 + h);
  const double y = cosine2 > 0 ? std::clamp(h * std::sqrt(r2 / cosine2), y0_, y1_) : (h > 0 ? y1_ : y0_);
  return {x, y};
}

}  // namespace relook
