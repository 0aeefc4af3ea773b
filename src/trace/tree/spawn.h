// Which rays a hit sends on: a node of a ray tree, its object and the options in; its spawned rays, and what the
// Fresnel cut-off held back, out.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "scene/integrator.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// Which rays there are, beside what surfaces say.
struct SpawnRule {
  std::uint32_t max_depth = 6;  // generations of rays
  Integrator integrator = Integrator::whitted;
  std::uint32_t diffuse_depth = 0, glossy_depth = 4, transmission_depth = 16;  // bounces, of the path integrator
  /// Might a hit send a ray on at all?
  [[nodiscard]] bool may_spawn(const RayObject& object) const {
    return integrator == Integrator::path || object.optics.spawns();
  }
};

/// The rays that a hit spawns, and the branches that only the Fresnel cut-off held back. A pure function of the node,
/// its object and the rule.
struct Spawned {
  std::array<SpawnedRay, kBranches> rays;
  BranchSet branches;  // whose rays are there
  BranchSet cut;
  std::optional<VertexLobes> lobes;  // of the path integrator

  [[nodiscard]] const SpawnedRay& ray(Branch branch) const { return rays[static_cast<std::size_t>(branch)]; }
};
[[nodiscard]] Spawned spawn(const RayNode& node, const RayObject& object, const SpawnRule& rule);

}  // namespace relook
