// Which rays a hit sends on: a node of a ray tree, its object and the options in; its spawned rays, and what the Fresnel
// cut-off held back, out.
#pragma once
#include <array>
#include <cstdint>

#include "trace/tree/tree_block.h"

namespace relook {

/// The rays that a hit spawns, and the branches that only the Fresnel cut-off held back. A pure function of the node,
/// its object and the options.
struct Spawned {
  std::array<SpawnedRay, kBranches> rays;
  std::uint8_t mask = 0;  // bit b: rays[b] is there
  std::uint8_t cut_mask = 0;
};
[[nodiscard]] Spawned spawn(const RayNode& node, const RayObject& object, std::uint32_t max_depth);

}  // namespace relook
