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
#include "trace/tree/branch.h"

namespace relook {

struct RayNode;
class VertexTexels;

struct VertexLobes {
  LobeShares shares{0, 0, 0};
  Basis base, coat_base;           // about the normal of the base layer, and of the coat
  Direction view, coat_view;       // in these
  DiffuseDirections diffuse;
  GlossyLobe specular{1, 1}, coat{1, 1}, transmission{1, 1};
  AlphaBucket specular_bucket{-1}, coat_bucket{-1}, transmission_bucket{-1};
  float shininess = -1;            // that samples the coat of blinn-phong, its power lobe; below 0: the coat is GGX's
  float eta = 0;                   // of transmission: index behind over index in front; 0: a thin surface, mirrored
  Channel channel = Channel::all;  // of what a volume transmits
  bool is_channel_chosen = false;  // it is one of three that part here

  [[nodiscard]] bool any() const {
    return shares.diffuse + shares.specular + shares.coat + shares.transmission > 0;
  }
  /// The density of a unit direction of the world per steradian, times the lobe's share; 0 below the lobe's normal.
  [[nodiscard]] float density(Lobe lobe, const Direction& way) const;
  /// A local direction, of about length 1; none where the sample leads nowhere.
  [[nodiscard]] std::optional<Direction> direction(Lobe lobe, Uv u) const;
  /// Is it so wide that lights with a size reach it through volumes by shadow segments?
  [[nodiscard]] bool is_wide(Lobe lobe) const {
    return lobe == Lobe::diffuse || bucket(lobe).lower() >= 0.25F;
  }
  /// Requires: not of the diffuse lobe.
  [[nodiscard]] AlphaBucket bucket(Lobe lobe) const {
    return lobe == Lobe::specular ? specular_bucket : lobe == Lobe::coat ? coat_bucket : transmission_bucket;
  }

 private:
  [[nodiscard]] std::optional<Direction> transmitted(Uv u) const;
  [[nodiscard]] float transmitted_density(const Direction& way) const;  // of a local one, without the share
};

/// Of a hit with everything that follows from it. `normal`, `coat_normal`: with their maps; `texels`: of the node.
[[nodiscard]] VertexLobes lobes_at(const RayNode& node, const RayObject& object, const Normal& normal,
                                   const Normal& coat_normal, const VertexTexels& texels);
/// Which lobes an object has on that side of its surface.
[[nodiscard]] LobeSet lobe_set(const RayObject& object, bool inside);
/// The index of refraction for a channel; all of them: that of the middle.
[[nodiscard]] float channel_ior(const SurfaceOptics& optics, Channel channel);

/// A direction of one lobe; none where its sample leads below the surface, or, transmitted, above it.
struct LobeSample {
  Lobe lobe;
  Direction way;  // unit, world
  float density;  // times the share
};
[[nodiscard]] std::optional<LobeSample> sample_lobe(const VertexLobes& lobes, const Normal& geometric, Uv u);

}  // namespace relook
