// Top levels over single objects: to find a ray's hit again when its path says which object it meets (paper 4.1.2).
// Hits are those of the whole scene, bit for bit, since they depend on the ray and the object alone. A level is built
// when a ray first asks for it, by whatever thread that is, and kept while it holds.
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "trace/tracer.h"

namespace relook {

class ObjectLevels {
 public:
  explicit ObjectLevels(const RayScene& scene, MemoryMonitor monitor = {});

  /// Goes on with another state of the scene: `changed` are the objects that rays meet otherwise than before, or new
  /// ones. Not while rays are shot.
  void go_on(const RayScene& scene, std::span<const ObjectId> changed);
  /// The level over one object.
  [[nodiscard]] const Tracer::TopLevel& of(ObjectId id) const;

 private:
  struct Built {
    std::shared_ptr<const RayObject> object;  // to which the level points
    std::unique_ptr<const Tracer::TopLevel> level;
  };

  void drop(std::span<const ObjectId> changed);

  RayScene scene_;
  mutable std::mutex mutex_;  // of everything below
  mutable Tracer tracer_;
  mutable std::vector<Built> levels_;                                 // those that are built
  std::unique_ptr<std::atomic<const Tracer::TopLevel*>[]> by_object_;  // null: not built; read without the mutex
  std::size_t objects_ = 0;
};

}  // namespace relook
