// The density with which a glossy lobe is sampled: reflections by visible normals, and a share by cosine where the lobe
// is wide, since such normals miss part of it at grazing angles. Local directions (basis.h).
#pragma once
#include <optional>

#include "physics/cosine_sample.h"
#include "physics/ggx_sample.h"

namespace relook {

struct GlossyLobe {
  float alpha_x, alpha_y;  // along the basis's axes; equal where the surface is not brushed

  /// None where the microfacet sends the light below the surface.
  [[nodiscard]] std::optional<Direction> sample(const Direction& view, const Uv& u) const {
    const float share = cosine_share();
    if (u.x < share) return cosine_direction({u.x / share, u.y});
    const Direction seen = facing(view);
    const Uv rest((u.x - share) / (1.0F - share), u.y);
    const Direction way = reflected_direction(seen, visible_normal(alpha_x, alpha_y, seen, rest));
    if (!(way.z > 0.0F)) return std::nullopt;
    return way;
  }
  /// Per steradian: what `sample` has of ways above the surface. `way`: of length 1.
  [[nodiscard]] float density(const Direction& view, const Direction& way) const {
    const float share = cosine_share();
    const float reflected = ggx_reflection_density(alpha_x, alpha_y, facing(view), way);
    return share * cosine_density(way.z) + (1.0F - share) * reflected;
  }

  /// The share of samples by cosine.
  [[nodiscard]] float cosine_share() const { return min(alpha_x, alpha_y) >= 0.25F ? 0.1F : 0.0F; }
};

}  // namespace relook
