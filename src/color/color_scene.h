// What colours are worked out from: the scene frozen for rays, and the Scene whose colour parameters programs read in
// place. The Scene is the one that edits change, so a ColorScene says that both are of one state: it is made after an
// edit, and the next edit ends it. What outlives an edit, such as the state before it, is a RayScene.
#pragma once
#include "scene/scene.h"
#include "trace/ray_scene.h"

namespace relook {

class ColorScene : public RayScene {
 public:
  /// `scene` outlives it.
  explicit ColorScene(const Scene& scene) : RayScene(scene), scene_(&scene) {}
  /// `rays`: made from `scene` as it is now.
  ColorScene(RayScene rays, const Scene& scene) : RayScene(std::move(rays)), scene_(&scene) {}

  [[nodiscard]] const Scene& scene() const { return *scene_; }

 private:
  const Scene* scene_;
};

}  // namespace relook
