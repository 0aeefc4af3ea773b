// What the steps of a replay work on together: the scene, ready for rays, the image, and what is kept from one step to
// the next.
#pragma once
#include <memory>
#include <vector>

#include "cache/residency/residency.h"
#include "color/color_scene.h"
#include "image/stored_image.h"
#include "image/tile_light.h"
#include "replay/color_tree_store.h"
#include "replay/kept_selection.h"
#include "scene/compile/state.h"
#include "trace/object_levels.h"
#include "trace/scene_level.h"

namespace relook {

struct ReplayParts {
  /// As the constructor of Replayer. It stays where it is: its parts refer to each other.
  ReplayParts(SceneState start, Image image, const RegionOptions& options, std::unique_ptr<Residency> pieces,
              std::shared_ptr<StoredTunnels> tunnels);
  ReplayParts(const ReplayParts&) = delete;
  ReplayParts& operator=(const ReplayParts&) = delete;

  [[nodiscard]] const Image& image() const { return stored.image(); }
  /// See atoms_of(); empty without atoms.
  [[nodiscard]] std::vector<ObjectId> atoms() const;
  /// The scene as it is now. `scene_level`: over all of it; null if nothing is traced.
  [[nodiscard]] GrowScene grow(const Tracer::TopLevel* scene_level = nullptr) const {
    return grow_scene(rays, scene_level, image().view, image().view.shadow_bits, &objects);
  }
  /// The level over the scene as it is now, without the objects `absent` (increasing).
  [[nodiscard]] const Tracer::TopLevel& current_level(std::span<const ObjectId> absent);

  SceneState state;
  ColorScene rays;  // of the state
  std::unique_ptr<Residency> owned_residency;
  Residency& residency{*owned_residency};
  StoredImage stored;
  ObjectLevels objects;
  ProgramTable programs;
  KeptSelection selection{stored.samples()};  // a byte a sample
  ColorTreeStore color_trees;
  std::unique_ptr<SceneLevel> level;  // null until a step first needs rays

 private:
  /// Tells the residency what acceleration structures take, so that pieces make room for them; none without a limit.
  [[nodiscard]] MemoryMonitor monitor();
};

}  // namespace relook
