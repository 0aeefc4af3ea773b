#include "trace/object_levels.h"

namespace relook {
namespace {

/// An object's top level takes some 10 KB: no more of them stay than this, beside those of the pass at hand.
constexpr std::size_t kMostKept = 4096;

}  // namespace

void ObjectLevels::note_changed(std::span<const ObjectId> objects) {
  for (const ObjectId id : objects) {
    if (id.index() >= levels_.size() || !levels_[id.index()]) continue;
    levels_[id.index()].reset();
    --built_;
  }
}

void ObjectLevels::prepare(std::span<const ObjectId> objects) {
  if (built_ > kMostKept) {
    levels_.clear();
    built_ = 0;
  }
  levels_.resize(scene_.size());
  for (const ObjectId id : objects) {
    std::unique_ptr<Tracer::TopLevel>& level = levels_[id.index()];
    if (level) continue;
    const Tracer::Placed placed{id, &scene_.object(id)};
    level = std::make_unique<Tracer::TopLevel>(tracer_.build(std::span(&placed, 1)));
    ++built_;
  }
}

}  // namespace relook
