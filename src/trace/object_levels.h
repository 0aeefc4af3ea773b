// Top levels over single objects: to find a ray's hit again when its path says which object it meets (paper 4.1.2).
// Hits are those of the whole scene, bit for bit, since they depend on the ray and the object alone. Levels are built
// before a pass for the objects that it may ask for, and kept while they hold.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "trace/tracer.h"

namespace relook {

class ObjectLevels {
 public:
  /// `scene` outlives it.
  explicit ObjectLevels(const RayScene& scene) : scene_(scene) {}

  /// Notes objects whose entries in the ray scene are others than before.
  void note_changed(std::span<const ObjectId> objects);
  /// Builds what is missing for these objects (each named once, say). Not while rays are shot.
  void prepare(std::span<const ObjectId> objects);
  /// The level over one object. Requires: it has been prepared.
  [[nodiscard]] const Tracer::TopLevel& of(ObjectId id) const { return *levels_[id.index()]; }

 private:
  const RayScene& scene_;
  Tracer tracer_;
  std::vector<std::unique_ptr<Tracer::TopLevel>> levels_;  // by ObjectId; null: not built
  std::size_t built_ = 0;
};

}  // namespace relook
