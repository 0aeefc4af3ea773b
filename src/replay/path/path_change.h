// What one edit means to the sums of light of a frame of the path integrator: which stay, which are worked out afresh,
// which lights' terms are taken out of sums that they share and put in, and which samples' terms change in all of them.
// The scene delta in; what path_tile.h carries out, out.
#pragma once
#include <memory>
#include <vector>

#include "color/color_scene.h"
#include "replay/change.h"
#include "scene/light_sums.h"

namespace relook {

struct PathChange {
  explicit PathChange(RayScene before) : rays_before(std::move(before)) {}

  StepChange step;
  std::vector<LightSum> sums;              // after the edit
  std::vector<std::uint32_t> old_of_new;   // by sum: its place before; kNewSum
  std::vector<std::uint8_t> afresh;        // by sum, none that is shared: all its terms may be others; they follow from
                                           // the trees
  std::vector<std::uint8_t> taken;         // by place in the light order before: its terms leave a shared sum
  std::vector<std::uint8_t> given;         // by place in that after: its terms are added, to a sum afresh or a shared one
  bool recolored = false;                  // a sum's colour is another one, or sums have come or gone
  std::vector<MaterialId> shaded;          // materials whose users' terms change
  std::shared_ptr<const Scene> scene_before;  // where samples are touched; else null
  RayScene rays_before;

  [[nodiscard]] bool any_afresh() const;
  [[nodiscard]] bool any_taken() const;
  [[nodiscard]] bool any_given() const;
  /// Do terms of some lights change, whatever else does?
  [[nodiscard]] bool relights() const { return any_afresh() || any_taken() || any_given(); }
  /// Must trees be looked at at all?
  [[nodiscard]] bool touches_samples() const;
};

/// `rays_before`, `lights_before`, `sums_before`: as before the edit; `scene`, `rays`: as after it.
[[nodiscard]] PathChange find_path_change(const RayScene& rays_before, const std::vector<LightId>& lights_before,
                                          const std::vector<LightSum>& sums_before, const Scene& scene,
                                          const RayScene& rays, const SceneDelta& delta);

}  // namespace relook
