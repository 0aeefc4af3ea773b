// The top level over the whole scene through a series of edits: what an edit moves is hidden in the level built before
// and put into a small one on top of it, so that the price of an edit follows from the edit.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trace/tracer.h"

namespace relook {

class SceneLevel {
 public:
  explicit SceneLevel(bool count_blockers, MemoryMonitor monitor = {}) : tracer_(count_blockers, std::move(monitor)) {}
  [[nodiscard]] Tracer& tracer() { return tracer_; }

  /// Notes objects that rays or shadow segments meet otherwise than before.
  void note_changed(std::span<const ObjectId> objects);
  /// The scene as it is now, without the objects `absent` (increasing). Valid until the next call.
  [[nodiscard]] const Tracer::TopLevel& current(const RayScene& scene, std::span<const ObjectId> absent = {});

 private:
  Tracer tracer_;
  std::optional<RayScene> base_;  // the state over which the level was built; none: not built
  std::vector<std::shared_ptr<const RayObject>> on_top_;  // what the small level on top of it points to
  Tracer::TopLevel level_;
  std::vector<ObjectId> changed_;  // since the level was built, increasing
};

}  // namespace relook
