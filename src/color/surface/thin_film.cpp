#include "color/surface/thin_film.h"

#include <array>
#include <cmath>
#include <numbers>

#include "color/surface/surface_terms.h"

namespace relook {
namespace {

/// From here on the Gaussians below are 0 in a float: bounds the argument of the cosine.
constexpr float kLongestPath = 1e5F;  // nanometres

/// The CIE's colour matching functions in the Fourier domain: X (its greater part), Y, Z, and the rest of X.
struct Gaussian {
  double value, position, variance;
};
constexpr std::array<Gaussian, 4> kMatching{{{5.4856e-13, 1.6810e+06, 4.3278e+09},
                                             {4.4201e-13, 1.7953e+06, 9.3046e+09},
                                             {5.2481e-13, 2.2084e+06, 6.6121e+09},
                                             {9.7470e-14, 2.2399e+06, 4.5282e+09}}};
constexpr double kMatchingArea = 1.0685e-7;

/// One Gaussian at an optical path difference in nanometres.
Scalar response(const Gaussian& matching, Scalar path) {
  constexpr double kNanometre = 1e-9, kPhase = 2 * std::numbers::pi * kNanometre;
  const double amplitude = matching.value * std::sqrt(2 * std::numbers::pi * matching.variance) / kMatchingArea;
  const double decay = -kPhase * kPhase * matching.variance * std::numbers::log2e;
  const Scalar wave = cos_turns(path * static_cast<float>(matching.position * kNanometre));
  return wave * exp2(path * path * static_cast<float>(decay)) * static_cast<float>(amplitude);
}

/// What is seen of light that lags by `path`, linear Rec.709. `sign`: of X, Y and Z; -1 where half a turn is added.
Triple interference(Scalar path, const Triple& sign) {
  const Scalar x = (response(kMatching[0], path) + response(kMatching[3], path)) * sign.x;
  const Scalar y = response(kMatching[1], path) * sign.y, z = response(kMatching[2], path) * sign.z;
  return {x * 3.2404542F - y * 1.5371385F - z * 0.4985314F, y * 1.8760108F - x * 0.9692660F + z * 0.0415560F,
          x * 0.0556434F - y * 0.2040259F + z * 1.0572252F};
}

Scalar square(Scalar x) { return x * x; }
Scalar schlick_of(Scalar r0, Scalar weight) { return r0 + (1.0F - r0) * weight; }

/// Of one channel: sums of the reflections within the film.
struct FilmChannel {
  Scalar mean;           // what does not interfere
  Scalar first, second;  // what interferes once and twice
  Scalar sign;           // of `first`
};
FilmChannel channel(Scalar f0, Scalar film_ior, Scalar r12, Scalar weight_below) {
  const Scalar root = sqrt(min(f0 + 1e-4F, 0.9999F));
  const Scalar base_ior = (1.0F + root) / (1.0F - root);
  const Scalar r23 = schlick_of(square((base_ior - film_ior) / (base_ior + film_ior)), weight_below);
  const Scalar both = min(max(r12 * r23, 1e-5F), 0.9999F);
  const Scalar passed = 1.0F - r12;
  const Scalar rest = passed * passed * r23 / (1.0F - both);
  const Scalar amplitude = sqrt(both);
  const Scalar first = (rest - passed) * amplitude;
  // Half a turn is lost where the film is entered from air (seen from below), and another where the base is thinner.
  return {r12 + rest, first, first * amplitude, if_positive(film_ior - base_ior, number(f0, 1), number(f0, -1))};
}

}  // namespace

Triple film_fresnel(const ThinFilm& film, const Triple& f0, Scalar cosine) {
  const Scalar c = min(cosine, 1.0F);
  const Scalar cos_below = sqrt(max(1.0F - (1.0F - c * c) / (film.ior * film.ior), 0.0F));
  const Scalar r12 = schlick_of(square((film.ior - 1.0F) / (film.ior + 1.0F)), schlick(c));
  const Scalar weight_below = schlick(cos_below);
  const auto of = [&](Scalar f) { return channel(f, film.ior, r12, weight_below); };
  const FilmChannel red = of(f0.x), green = of(f0.y), blue = of(f0.z);
  const Scalar path = min(film.ior * max(film.thickness, 0.0F) * cos_below * 2.0F, kLongestPath);
  const Scalar one = number(c, 1);
  const Triple once = interference(path, {red.sign, green.sign, blue.sign}) * number(c, 2);
  const Triple twice = interference(path * 2.0F, {one, one, one}) * number(c, 2);
  const Triple sum = Triple{red.mean, green.mean, blue.mean} + Triple{red.first, green.first, blue.first} * once +
                     Triple{red.second, green.second, blue.second} * twice;
  return {max(sum.x, 0.0F), max(sum.y, 0.0F), max(sum.z, 0.0F)};
}

}  // namespace relook
