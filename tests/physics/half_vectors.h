// Integrals over the directions that a GGX lobe reflects, in doubles and independent of src/physics: half vectors are
// drawn evenly by the distribution itself, so narrow lobes cost no more points than wide ones.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "base/math.h"
#include "pi.h"

namespace relook::test {

using Wide = Imath::V3d;

struct Alphas {
  double x, y;
};

/// A half vector by numbers in [0, 1): slopes alpha_x r cos and alpha_y r sin, r^2 = s / (1 - s), s = 1 - (1 - t)^2.
struct HalfPlace {
  double t, turn;
};
[[nodiscard]] inline Wide half_at(const Alphas& a, const HalfPlace& at) {
  const double s = 1 - (1 - at.t) * (1 - at.t), r = std::sqrt(s / (1 - s)), angle = 2 * kPi * at.turn;
  return Wide(a.x * r * std::cos(angle), a.y * r * std::sin(angle), 1).normalized();
}
[[nodiscard]] inline HalfPlace place_of(const Alphas& a, const Wide& half) {
  const double x = half.x / half.z / a.x, y = half.y / half.z / a.y, r2 = x * x + y * y;
  const double turn = std::atan2(y, x) / (2 * kPi);
  return {1 - std::sqrt(1 / (1 + r2)), turn < 0 ? turn + 1 : turn};
}

[[nodiscard]] inline double distribution(const Alphas& a, const Wide& h) {
  const double e = h.x * h.x / (a.x * a.x) + h.y * h.y / (a.y * a.y) + h.z * h.z;
  return 1 / (kPi * a.x * a.y * e * e);
}
/// Smith's Lambda.
[[nodiscard]] inline double hidden(const Alphas& a, const Wide& w) {
  return (std::sqrt(1 + (a.x * a.x * w.x * w.x + a.y * a.y * w.y * w.y) / (w.z * w.z)) - 1) / 2;
}
/// The density of visible normals, per steradian of the half vector.
[[nodiscard]] inline double visible(const Alphas& a, const Wide& view, const Wide& half) {
  return std::max(view.dot(half), 0.0) * distribution(a, half) / (1 + hidden(a, view)) / view.z;
}
/// D G2 / (4 NL NV), with heights that are correlated.
[[nodiscard]] inline double lobe(const Alphas& a, const Wide& view, const Wide& way, const Wide& half) {
  return distribution(a, half) / (1 + hidden(a, view) + hidden(a, way)) / (4 * view.z * way.z);
}

/// Of f(half, way), a density of half vectors, over those in front of the view, by midpoints within a rectangle of
/// places.
template <class F>
[[nodiscard]] double integral(const Alphas& a, const Wide& view, const F& f, int steps, HalfPlace from = {0, 0},
                              HalfPlace to = {1, 1}) {
  double sum = 0;
  const double dt = (to.t - from.t) / steps, dturn = (to.turn - from.turn) / steps;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const HalfPlace at{from.t + (i + 0.5) * dt, from.turn + (j + 0.5) * dturn};
      const Wide half = half_at(a, at);
      const double vh = view.dot(half);
      if (vh > 0) sum += f(half, half * (2 * vh) - view) * 2 * (1 - at.t) / (distribution(a, half) * half.z);
    }
  return sum * dt * dturn;
}

[[nodiscard]] inline Direction narrow(const Wide& d) {
  return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
}
/// At this cosine; `turn`: about the normal.
[[nodiscard]] inline Wide view_at(double cosine, double turn) {
  const double out = std::sqrt(1 - cosine * cosine);
  return {out * std::cos(2 * kPi * turn), out * std::sin(2 * kPi * turn), cosine};
}

/// Points of the unit square.
class Points {
 public:
  explicit Points(std::uint32_t seed) : random_(seed) {}
  [[nodiscard]] Uv next() {
    const float x = number();
    return {x, number()};
  }

 private:
  [[nodiscard]] float number() { return static_cast<float>(static_cast<std::uint32_t>(random_()) >> 8) * 0x1p-24F; }
  std::mt19937 random_;
};

/// The mean of numbers, and how far it may be from the true one.
class Mean {
 public:
  void add(double x) { ++count_, sum_ += x, squares_ += x * x; }
  [[nodiscard]] double value() const { return sum_ / count_; }
  [[nodiscard]] double five_sigma() const {
    return 5 * std::sqrt(std::max(squares_ / count_ - value() * value(), 0.0) / count_);
  }

 private:
  double count_ = 0, sum_ = 0, squares_ = 0;
};

}  // namespace relook::test
