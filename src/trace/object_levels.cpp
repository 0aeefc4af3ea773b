#include "trace/object_levels.h"

#include <algorithm>

#include "base/parallel.h"

namespace relook {
namespace {

/// An object's top level takes some 10 KB: where more than this many are there, the next edit drops all.
constexpr std::size_t kMostKept = 4096;

}  // namespace

ObjectLevels::ObjectLevels(const RayScene& scene, MemoryMonitor monitor)
    : scene_(scene), tracer_(false, std::move(monitor)) {
  go_on(scene, {});
}

void ObjectLevels::go_on(const RayScene& scene, std::span<const ObjectId> changed) {
  scene_ = scene;
  if (objects_ != scene_.size() || levels_.size() > kMostKept) {
    auto none_built = std::make_unique<std::atomic<const Tracer::TopLevel*>[]>(scene_.size());
    by_object_ = std::move(none_built);
    objects_ = scene_.size();
    levels_.clear();
  } else {
    drop(changed);
  }
  tracer_.drop_unused();
}

void ObjectLevels::drop(std::span<const ObjectId> changed) {
  std::vector<const Tracer::TopLevel*> gone;
  for (const ObjectId id : changed)
    if (const Tracer::TopLevel* old = by_object_[id.index()].exchange(nullptr)) gone.push_back(old);
  if (gone.empty()) return;
  std::ranges::sort(gone);
  std::erase_if(levels_, [&](const Built& built) { return std::ranges::binary_search(gone, built.level.get()); });
}

const Tracer::TopLevel& ObjectLevels::of(ObjectId id) const {
  std::atomic<const Tracer::TopLevel*>& place = by_object_[id.index()];
  if (const Tracer::TopLevel* level = place.load(std::memory_order_acquire)) return *level;
  const std::lock_guard lock(mutex_);
  if (const Tracer::TopLevel* level = place.load(std::memory_order_relaxed)) return *level;
  run_isolated([&] {
    const Tracer::Placed placed{id, &scene_.object(id)};
    levels_.push_back(
        {scene_.share(id), std::make_unique<const Tracer::TopLevel>(tracer_.build(std::span(&placed, 1)))});
  });
  place.store(levels_.back().level.get(), std::memory_order_release);
  return *levels_.back().level;
}

}  // namespace relook
