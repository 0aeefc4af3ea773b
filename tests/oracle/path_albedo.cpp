#include "path_albedo.h"

#include <algorithm>
#include <cmath>

#include "pi.h"

namespace relook {

double schlick_reflectance(double f0, double cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

double fresnel_reflectance(double ior, double cosine) {
  const double behind = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
  const double s = (cosine - ior * behind) / (cosine + ior * behind);
  const double p = (behind - ior * cosine) / (behind + ior * cosine);
  return (s * s + p * p) / 2;
}

double ggx_albedo(double nv, double roughness, const Reflectance& reflectance) {
  // Half vectors as likely as D times their cosine, in even steps; a light at l has f cos / density = V NL 4 VH / NH.
  constexpr int kTilts = 2048, kTurns = 256;
  const double alpha = std::pow(std::max(roughness, 0.05), 2), a2 = alpha * alpha, vx = std::sqrt(1 - nv * nv);
  double sum = 0;
  for (int i = 0; i < kTilts; ++i) {
    const double u = (i + 0.5) / kTilts;
    const double nh = 1 / std::sqrt(1 + a2 * u / (1 - u)), sine = std::sqrt(1 - nh * nh);
    for (int j = 0; j < kTurns; ++j) {
      const double vh = sine * std::cos(2 * kPi * (j + 0.5) / kTurns) * vx + nh * nv, nl = 2 * vh * nh - nv;
      if (vh <= 0 || nl <= 0) continue;
      const double smith = nv * std::sqrt(nl * nl * (1 - a2) + a2) + nl * std::sqrt(nv * nv * (1 - a2) + a2);
      sum += 0.5 / smith * nl * 4 * vh / nh * reflectance(std::min(vh, 1.0));
    }
  }
  return sum / (double{kTilts} * kTurns);
}

double rough_transmittance(double nv, double roughness, double eta) {
  // As above: what a facet at h lets through has (1 - F) G VH / (NV NH), with G of Smith for each side.
  constexpr int kTilts = 2048, kTurns = 256;
  const double alpha = std::pow(std::max(roughness, 0.05), 2), a2 = alpha * alpha, vx = std::sqrt(1 - nv * nv);
  const auto seen = [&](double c) { return 2 * c / (c + std::sqrt(c * c * (1 - a2) + a2)); };
  double sum = 0;
  for (int i = 0; i < kTilts; ++i) {
    const double u = (i + 0.5) / kTilts;
    const double nh = 1 / std::sqrt(1 + a2 * u / (1 - u)), sine = std::sqrt(1 - nh * nh);
    for (int j = 0; j < kTurns; ++j) {
      const double vh = sine * std::cos(2 * kPi * (j + 0.5) / kTurns) * vx + nh * nv;
      const double behind2 = 1 - (1 - vh * vh) / (eta * eta);
      if (vh <= 0 || behind2 <= 0) continue;
      const double nl = nv / eta - nh * (vh / eta - std::sqrt(behind2));
      if (nl > 0) sum += (1 - fresnel_reflectance(eta, std::min(vh, 1.0))) * seen(nv) * seen(nl) * vh / (nv * nh);
    }
  }
  return sum / (double{kTilts} * kTurns);
}

namespace {

/// The integral of value(nl, nh2) times nl over directions of a hemisphere; nh2: the squared cosine of the half vector.
template <class Value>
double reflected_share(double nv, const Value& value) {
  constexpr int kHeights = 2048, kTurns = 256;
  const double vx = std::sqrt(1 - nv * nv);
  double sum = 0;
  for (int i = 0; i < kHeights; ++i) {
    const double nl = (i + 0.5) / kHeights, sine = std::sqrt(1 - nl * nl);
    for (int j = 0; j < kTurns; ++j) {
      const double turn = 2 * kPi * (j + 0.5) / kTurns;
      const double x = sine * std::cos(turn) + vx, y = sine * std::sin(turn), z = nl + nv;
      sum += value(nl, z * z / (x * x + y * y + z * z)) * nl;
    }
  }
  return sum * 2 * kPi / (double{kHeights} * kTurns);
}

}  // namespace

double power_albedo(double nv, double shininess) {
  return reflected_share(nv, [&](double /*nl*/, double nh2) {
    return (shininess + 8) / (8 * kPi) * std::pow(nh2, 0.5 * shininess);
  });
}

double cloth_albedo(double nv, double roughness) {
  const double alpha = std::pow(std::max(roughness, 0.07), 2);
  return reflected_share(nv, [&](double nl, double nh2) {
    return (2 + 1 / alpha) * std::pow(1 - nh2, 0.5 / alpha) / (2 * kPi) / (4 * (nl + nv - nl * nv));
  });
}

}  // namespace relook
