// Which rays a hit sends on: a node of a ray tree, its object and the options in; its spawned rays, and what the
// Fresnel cut-off held back, out.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>

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

/// The rays that a hit spawns, and the branches that only the Fresnel cut-off held back.
class Spawned {
 public:
  BranchSet cut;
  std::optional<VertexLobes> lobes;  // of the path integrator

  Spawned() = default;
  Spawned(const Spawned&) = delete;
  Spawned& operator=(const Spawned&) = delete;

  /// Whose rays are there.
  [[nodiscard]] BranchSet branches() const { return branches_; }
  /// Requires: it is there.
  [[nodiscard]] const SpawnedRay& ray(Branch branch) const { return slots_[static_cast<std::size_t>(branch)].ray; }
  SpawnedRay& add(Branch branch) {
    branches_.add(branch);
    return *std::construct_at(&slots_[static_cast<std::size_t>(branch)].ray);
  }

 private:
  /// Room for a ray: most hits spawn one or two, and the others are never written.
  union Slot {
    Slot() {}
    SpawnedRay ray;
  };
  static_assert(std::is_trivially_destructible_v<SpawnedRay>);
  std::array<Slot, kBranches> slots_;
  BranchSet branches_;
};
/// Where a ray leaves a surface. `side`: +1 that of the ray that came, -1 the other.
[[nodiscard]] inline Point left_at(const SurfacePoint& point, float side) {
  return point.position + point.geometric * (side * point.offset);
}
/// The way of a ray that goes straight on from a completed node.
void go_straight(const RayNode& node, const RayObject& object, SpawnedRay& ray);
/// The lobes of a completed node of the path integrator, as spawn() finds them; without any where none scatters.
[[nodiscard]] VertexLobes find_lobes(const RayNode& node, const RayObject& object);
/// Adds them to `spawned`, which is empty. A pure function of the node, its object and the rule.
void spawn(const RayNode& node, const RayObject& object, const SpawnRule& rule, Spawned& spawned);

}  // namespace relook
