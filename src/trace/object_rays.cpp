#include "trace/object_rays.h"

#include <algorithm>

#include "base/error.h"

namespace relook {

void refuse_trees() {
  throw Error(ExitCode::damaged_cache, "", "", "stored ray trees do not fit the scene; preprocess again");
}

Meeting ObjectRays::meeting(ObjectId object, const Ray& ray) {
  ++counters_.object_rays;
  const Meeting meeting = Tracer::intersect(objects_->of(object), ray);
  if (meeting.object.is_none()) refuse_trees();
  ++found_;
  return meeting;
}

const std::vector<Crossing>& ObjectRays::filters(std::span<const std::uint32_t> objects, const ShadowSegment& segment) {
  crossings_.clear();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (std::ranges::count(objects.first(i), objects[i]) > 0) continue;
    ++counters_.object_rays;
    const Ray ray = segment.ray();
    if (!Tracer::passes(objects_->of(ObjectId(objects[i])), ray, of_object_)) refuse_trees();
    crossings_.insert(crossings_.end(), of_object_.begin(), of_object_.end());
  }
  std::ranges::sort(crossings_, {}, place_on_segment);
  if (!std::ranges::equal(crossings_, objects, {}, [](const Crossing& c) { return c.object.index(); })) refuse_trees();
  found_ += crossings_.size();
  return crossings_;
}

}  // namespace relook
