// Which rays a hit sends on: a node of a ray tree, its object and the options in; its spawned rays, and what the
// Fresnel cut-off held back, out.
#pragma once
#include <array>
#include <cstdint>

#include "trace/tree/tree_block.h"

namespace relook {

/// The rays that a hit spawns, and the branches that only the Fresnel cut-off held back. A pure function of the node,
/// its object and the options.
struct Spawned {
  std::array<SpawnedRay, kBranches> rays;
  BranchSet branches;  // whose rays are there
  BranchSet cut;

  [[nodiscard]] const SpawnedRay& ray(Branch branch) const { return rays[static_cast<std::size_t>(branch)]; }
};
[[nodiscard]] Spawned spawn(const RayNode& node, const RayObject& object, std::uint32_t max_depth);

}  // namespace relook
