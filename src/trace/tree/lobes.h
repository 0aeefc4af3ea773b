// The lobes of a hit as sampling sees them: their shares, and for each the density of its directions. They follow from
// structure and from what is optical anyway (which lobes there are, buckets, normals, the index of refraction), never from
// colours. Called by spawn.h, which takes a direction, and by light.h's weights (color/path).
#pragma once
#include <cstdint>
#include <optional>

#include "physics/basis.h"
#include "physics/glossy_lobe.h"
#include "physics/lobe_shares.h"
#include "trace/surface.h"

namespace relook {

struct RayNode;

struct VertexLobes {
  LobeShares shares{0, 0, 0};
  Basis base, coat_base;           // about the normal of the base layer, and of the coat
  Direction view, coat_view;       // in these
  GlossyLobe specular{1, 1}, coat{1, 1};
  AlphaBucket specular_bucket{-1}, coat_bucket{-1};

  [[nodiscard]] bool any() const { return shares.diffuse + shares.specular + shares.coat > 0; }
  /// The density of a unit direction of the world per steradian, times the lobe's share; 0 below the lobe's normal.
  [[nodiscard]] float density(Lobe lobe, const Direction& way) const;
  /// Is it so wide that lights with a size reach it through volumes by shadow segments?
  [[nodiscard]] bool is_wide(Lobe lobe) const {
    return lobe == Lobe::diffuse || (lobe == Lobe::specular ? specular_bucket : coat_bucket).lower() >= 0.25F;
  }
};

/// Of a hit with everything that follows from it. `normal`, `coat_normal`: with their maps.
[[nodiscard]] VertexLobes lobes_at(const RayNode& node, const RayObject& object, const Normal& normal,
                                   const Normal& coat_normal);
/// Which lobes a material has on that side of a surface.
[[nodiscard]] LobeSet lobe_set(const Material& material, const SurfaceOptics& optics, bool inside);

/// A direction of one lobe; none where its sample leads below the surface.
struct LobeSample {
  Lobe lobe;
  Direction way;  // unit, world
  float density;  // times the share
};
[[nodiscard]] std::optional<LobeSample> sample_lobe(const VertexLobes& lobes, const Normal& geometric, Uv u);

}  // namespace relook
