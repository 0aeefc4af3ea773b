// Which lobe of a material a ray follows: its lobes, a bucket and reflectances of its indices in, shares out. Colours,
// weights and textures have no say, so their edits keep the choice.
#pragma once
#include <cstdint>

#include "physics/lobe_buckets.h"
#include "physics/scalar.h"

namespace relook {

/// `diffuse` holds sheen, too; `coat` is the power lobe of blinn-phong; `transmission` that of what is let through where
/// it is blurred.
enum class Lobe : std::uint8_t { diffuse, specular, coat, transmission };

/// Which lobes a material has.
struct LobeSet {
  bool diffuse, specular, coat;
  bool transmission = false;
  [[nodiscard]] bool any() const { return diffuse || specular || coat || transmission; }
};

/// Together 1, and each at least kLeastShare where the lobe is there; 0 where it is not.
struct LobeShares {
  float diffuse, specular, coat;
  float transmission = 0;

  [[nodiscard]] float of(Lobe lobe) const {
    switch (lobe) {
      case Lobe::diffuse:
        return diffuse;
      case Lobe::specular:
        return specular;
      case Lobe::coat:
        return coat;
      case Lobe::transmission:
        break;
    }
    return transmission;
  }
};
inline constexpr float kLeastShare = 0.1F;
/// Of `specular` over a diffuse body, where a coat leaves so much: measured (relook_bench error), under a sky 0.1 costs
/// dark plastics a sixth more noise, and 0.25 bright ones a thirtieth.
inline constexpr float kLeastSpecularShare = 0.2F;

/// The share of what a boundary reflects, if a half of what it lets through comes back from below.
[[nodiscard]] inline float share_of_reflection(float reflectance) {
  return reflectance / (reflectance + (1.0F - reflectance) * 0.5F);
}

/// `reflectance`: of the dielectric body at the view's angle, exact (dielectric_reflectance); `coat`: of the coat there
/// (coat_reflectance). At least one lobe is there, or all shares are 0.
[[nodiscard]] inline LobeShares lobe_shares(const LobeSet& lobes, MetallicBucket metallic, float reflectance,
                                            float coat) {
  const float under = (lobes.diffuse ? kLeastShare : 0.0F) + (lobes.transmission ? kLeastShare : 0.0F);
  const float below = under + (lobes.specular ? kLeastShare : 0.0F);
  LobeShares shares{0, 0, 0};
  if (lobes.coat) shares.coat = below == 0.0F ? 1.0F : min(max(share_of_reflection(coat), kLeastShare), 1.0F - below);
  const float rest = 1.0F - shares.coat;
  if (lobes.transmission) {
    // What goes through comes back as bright as what is reflected.
    const float specular = metallic == MetallicBucket::dielectric ? reflectance
                           : metallic == MetallicBucket::mixed    ? 0.5F
                                                                  : 1.0F;
    if (lobes.specular) shares.specular = min(max(rest * specular, kLeastShare), rest - under);
    shares.transmission = (rest - shares.specular) * (lobes.diffuse ? 0.5F : 1.0F);
    if (lobes.diffuse) shares.diffuse = rest - shares.specular - shares.transmission;
    return shares;
  }
  if (lobes.diffuse && lobes.specular) {
    const float specular = metallic == MetallicBucket::dielectric ? share_of_reflection(reflectance)
                           : metallic == MetallicBucket::mixed    ? 0.5F
                                                                  : 1.0F;
    shares.specular = min(max(rest * specular, kLeastSpecularShare), rest - kLeastShare);
    shares.diffuse = rest - shares.specular;
  } else if (lobes.specular) {
    shares.specular = rest;
  } else if (lobes.diffuse) {
    shares.diffuse = rest;
  }
  return shares;
}

/// Of blinn-phong: `diffuse`, and its power lobe as `coat`.
[[nodiscard]] inline LobeShares power_shares(const LobeSet& lobes) {
  const float power = !lobes.coat ? 0.0F : lobes.diffuse ? 0.5F : 1.0F;
  return {lobes.diffuse ? 1.0F - power : 0.0F, 0, power};
}

struct LobeChoice {
  Lobe lobe;
  float u;  // [0, 1): what is left of the number that chose, to be used again
};

/// `u`: [0, 1); the shares are not all 0.
[[nodiscard]] inline LobeChoice chosen_lobe(const LobeShares& shares, float u) {
  constexpr float kLast = 0x1.fffffep-1F;
  const auto remapped = [](float offset, float share) { return max(min(offset / share, kLast), 0.0F); };
  if (u < shares.diffuse) return {Lobe::diffuse, remapped(u, shares.diffuse)};
  const float above = u - shares.diffuse;
  // Where rounding leaves a number beyond the last share, the last lobe takes it.
  if (shares.specular > 0.0F && (above < shares.specular || (shares.coat == 0.0F && shares.transmission == 0.0F)))
    return {Lobe::specular, remapped(above, shares.specular)};
  const float last = above - shares.specular;
  if (shares.coat > 0.0F && (last < shares.coat || shares.transmission == 0.0F))
    return {Lobe::coat, remapped(last, shares.coat)};
  if (shares.transmission > 0.0F) return {Lobe::transmission, remapped(last - shares.coat, shares.transmission)};
  return {Lobe::diffuse, kLast};
}

}  // namespace relook
