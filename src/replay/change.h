// What one edit means for rays and for colours, worked out once per step from the scene delta: the rest of the replay
// asks nothing else about the edit.
#pragma once
#include <vector>

#include "color/expression/parameter_set.h"
#include "color/surface/illumination.h"
#include "region/tunnel.h"
#include "trace/tree/grow.h"

namespace relook {

/// What differs in colour expressions.
struct ColorChange {
  ParameterSet parameters;               // whose values differ
  std::vector<MaterialId> restructured;  // of these materials: their expressions have another shape now
  bool new_environment = false;          // the environment has an image now, or none any more: likewise
  std::vector<ObjectId> reassigned;      // objects that have another material now

  [[nodiscard]] bool empty() const { return parameters.empty() && reassigned.empty(); }
  bool operator==(const ColorChange&) const = default;
};

struct StepChange {
  RayChange rays;
  ColorChange colors;
  bool any_moved = false, any_shadows = false, any_respawns = false;

  /// True if ray trees can change at all.
  [[nodiscard]] bool touches_rays() const { return any_moved || any_shadows || any_respawns || rays.lights_changed; }
  /// True if segments of paths that do not name a changed object may meet one now, or did so before.
  [[nodiscard]] bool touches_segments() const { return any_moved || any_shadows; }
};

/// `ray_scene`: as before the edit; `scene`: as after it. Top levels are not built yet.
[[nodiscard]] StepChange find_change(const RayScene& ray_scene, const Scene& scene, const SceneDelta& delta,
                                     const std::vector<LightId>& old_lights);

/// An edit of nothing. `lights`: the light order.
[[nodiscard]] StepChange no_change(const std::vector<LightId>& lights);

/// True if compressed colour trees can follow the change.
[[nodiscard]] bool is_compressible(const ColorChange& change);

/// Objects that have flag `moved` or `shadows`, increasing.
[[nodiscard]] std::vector<ObjectId> selection_of(const StepChange& change);

/// Where the selection was and is, for tests against tunnels. `absent`: objects that are nowhere now, increasing.
[[nodiscard]] ChangeBoxes boxes_of(const StepChange& change, const RayScene& ray_scene,
                                   std::span<const ObjectId> absent = {});

/// Builds the selection's top levels. `ray_scene`: as after the edit.
void build_selection(StepChange& change, const RayScene& ray_scene, std::span<const ObjectId> absent, Tracer& tracer);

}  // namespace relook
