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
  /// `scene` outlives it.
  explicit ObjectLevels(const RayScene& scene, MemoryMonitor monitor = {});

  /// The scene has changed: `objects` are those whose entries in it are others than before, or new. Not while rays are
  /// shot.
  void note_changed(std::span<const ObjectId> objects);
  /// The level over one object.
  [[nodiscard]] const Tracer::TopLevel& of(ObjectId id) const;

 private:
  const RayScene& scene_;
  mutable std::mutex mutex_;  // of everything below
  mutable Tracer tracer_;
  mutable std::vector<std::unique_ptr<const Tracer::TopLevel>> levels_;  // those that are built
  std::unique_ptr<std::atomic<const Tracer::TopLevel*>[]> by_object_;    // null: not built; read without the mutex
  std::size_t objects_ = 0;
};

}  // namespace relook
