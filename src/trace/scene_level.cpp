#include "trace/scene_level.h"

#include <algorithm>

namespace relook {

void SceneLevel::note_changed(std::span<const ObjectId> objects) {
  if (!base_) return;
  changed_.insert(changed_.end(), objects.begin(), objects.end());
  std::ranges::sort(changed_);
  const auto repeated = std::ranges::unique(changed_);
  changed_.erase(repeated.begin(), repeated.end());
}

const Tracer::TopLevel& SceneLevel::current(const RayScene& scene, std::span<const ObjectId> absent) {
  tracer_.drop_unused();
  // A level on top that holds much of the scene would slow every ray down.
  const std::size_t most = std::max<std::size_t>(512, scene.size() / 16);
  if (!base_ || changed_.size() > most) {
    level_ = tracer_.build(scene);
    changed_.clear();
    base_ = scene;
    tracer_.drop_unused();  // what only the level before was over
  }
  std::vector<ObjectId> hidden;
  std::ranges::set_union(changed_, absent, std::back_inserter(hidden));
  std::vector<Tracer::Placed> on_top;
  std::vector<std::shared_ptr<const RayObject>> kept;
  for (ObjectId id : changed_)
    if (!std::ranges::binary_search(absent, id)) {
      on_top.push_back({id, &scene.object(id)});
      kept.push_back(scene.share(id));
    }
  tracer_.replace(level_, hidden, on_top);
  on_top_ = std::move(kept);
  return level_;
}

}  // namespace relook
