// Reflectance of a surface under a thin film: KHR_materials_iridescence, after Belcour and Barla 2017, "A Practical
// Extension to Microfacet Theory for the Modeling of Varying Iridescence". A film, what lies below and a cosine in,
// reflectances of the three channels out.
#pragma once
#include <array>
#include <cmath>
#include <numbers>

#include "physics/fresnel.h"

namespace relook {

/// A film in air.
template <class S>
struct ThinFilm {
  S ior;        // at least 1
  S thickness;  // nanometres
};

namespace thin_film {

/// From here on the Gaussians below are 0 in a float: bounds the argument of the cosine.
inline constexpr float kLongestPath = 1e5F;  // nanometres

/// The CIE's colour matching functions in the Fourier domain: X (its greater part), Y, Z, and the rest of X.
struct Gaussian {
  double value, position, variance;
};
inline constexpr std::array<Gaussian, 4> kMatching{{{5.4856e-13, 1.6810e+06, 4.3278e+09},
                                                    {4.4201e-13, 1.7953e+06, 9.3046e+09},
                                                    {5.2481e-13, 2.2084e+06, 6.6121e+09},
                                                    {9.7470e-14, 2.2399e+06, 4.5282e+09}}};
inline constexpr double kMatchingArea = 1.0685e-7;

/// One Gaussian at an optical path difference in nanometres.
template <class S>
[[nodiscard]] S response(const Gaussian& matching, S path) {
  constexpr double kNanometre = 1e-9, kPhase = 2 * std::numbers::pi * kNanometre;
  const double amplitude = matching.value * std::sqrt(2 * std::numbers::pi * matching.variance) / kMatchingArea;
  const double decay = -kPhase * kPhase * matching.variance * std::numbers::log2e;
  const S wave = cos_turns(path * static_cast<float>(matching.position * kNanometre));
  return wave * exp2(path * path * static_cast<float>(decay)) * static_cast<float>(amplitude);
}

/// What is seen of light that lags by `path`, linear Rec.709. `sign`: of X, Y and Z; -1 where half a turn is added.
template <class C>
[[nodiscard]] C interference(ScalarOf<C> path, const C& sign) {
  using S = ScalarOf<C>;
  const S x = (response(kMatching[0], path) + response(kMatching[3], path)) * sign.x;
  const S y = response(kMatching[1], path) * sign.y, z = response(kMatching[2], path) * sign.z;
  return {x * 3.2404542F - y * 1.5371385F - z * 0.4985314F, y * 1.8760108F - x * 0.9692660F + z * 0.0415560F,
          x * 0.0556434F - y * 0.2040259F + z * 1.0572252F};
}

/// Of one channel: sums of the reflections within the film.
template <class S>
struct Reflections {
  S mean;           // what does not interfere
  S first, second;  // what interferes once and twice
  S sign;           // of `first`
};
template <class S>
[[nodiscard]] Reflections<S> reflections(S f0, S film_ior, S r12, S weight_below) {
  const S root = sqrt(min(f0 + 1e-4F, 0.9999F));
  const S base_ior = (1.0F + root) / (1.0F - root);
  const S r23 = reflectance_between(normal_reflectance(base_ior, film_ior), 1.0F, weight_below);
  const S both = min(max(r12 * r23, 1e-5F), 0.9999F);
  const S passed = 1.0F - r12;
  const S rest = passed * passed * r23 / (1.0F - both);
  const S amplitude = sqrt(both);
  const S first = (rest - passed) * amplitude;
  // Half a turn is lost where the film is entered from air (seen from below), and another where the base is thinner.
  return {r12 + rest, first, first * amplitude, if_positive(film_ior - base_ior, number(f0, 1), number(f0, -1))};
}

}  // namespace thin_film

/// For unpolarised light at a cosine of incidence; `f0`: of the bare surface in air at normal incidence. Not negative;
/// a channel may lie a little above 1, since colours of one wavelength lie outside Rec.709.
template <class C>
[[nodiscard]] C film_reflectance(const ThinFilm<ScalarOf<C>>& film, const C& f0, ScalarOf<C> cosine) {
  using S = ScalarOf<C>;
  const S c = min(cosine, 1.0F);
  const S cos_below = sqrt(max(1.0F - sin2_behind(c, film.ior), 0.0F));
  const S r12 = reflectance_between(normal_reflectance(film.ior, 1.0F), 1.0F, schlick(c));
  const S weight_below = schlick(cos_below);
  const auto of = [&](S f) { return thin_film::reflections(f, film.ior, r12, weight_below); };
  const thin_film::Reflections<S> red = of(f0.x), green = of(f0.y), blue = of(f0.z);
  const S path = min(film.ior * max(film.thickness, 0.0F) * cos_below * 2.0F, thin_film::kLongestPath);
  const S one = number(c, 1);
  const C once = thin_film::interference(path, C{red.sign, green.sign, blue.sign}) * number(c, 2);
  const C twice = thin_film::interference(path * 2.0F, C{one, one, one}) * number(c, 2);
  const C sum = C{red.mean, green.mean, blue.mean} + C{red.first, green.first, blue.first} * once +
                C{red.second, green.second, blue.second} * twice;
  return {max(sum.x, 0.0F), max(sum.y, 0.0F), max(sum.z, 0.0F)};
}

}  // namespace relook
