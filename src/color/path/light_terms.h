// What lights bring to a hit by samples of their own, and to a ray that crosses them: samples and densities in, weighted
// radiance out. Inside src/color/path.
#pragma once
#include <optional>
#include <span>

#include "color/path/path_programs.h"

namespace relook {

/// The share of a lamp's light that its range and cone leave at a place.
[[nodiscard]] float lamp_share(const Light& light, const Point& at);

/// The light at `place` of the light order, at a hit that it reaches. None: it brings nothing.
[[nodiscard]] std::optional<LightTerm> light_term(const ColorScene& scene, const TreeBlock& block, std::uint32_t node,
                                                  std::uint32_t place);

/// A hit that a light reaches.
struct LitHit {
  const RayNode& node;
  const VertexLobes* lobes;             // null: it has none
  std::span<const FilterNode> filters;  // on the segment
  const LightSample* sample;            // null: it is taken anew, of a light that has samples
};
/// The same; the term does not know its node.
[[nodiscard]] std::optional<LightTerm> light_term(const ColorScene& scene, const LitHit& hit, std::uint32_t place);

/// How much a light that a ray meets counts beside samples of it at the hit that sent the ray. `density`: with which
/// those have the ray's direction.
[[nodiscard]] float met_weight(const RayNode& node, const RayLight& light, float density);
/// May the ray to a node bring light of a light with a size at all?
[[nodiscard]] bool may_meet(const RayNode& node, const RayLight& ray_light, const Light& light);
/// The radiance of a light with a shape where the ray to a node crosses it before its end, weighted; none: it does not.
[[nodiscard]] std::optional<float> crossed(const RayNode& node, const RayLight& ray_light, const Light& light);

}  // namespace relook
