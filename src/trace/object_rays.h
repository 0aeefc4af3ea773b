// Hits that are not kept, found again by rays against the objects that a path names (paper 4.1.2), inside src/trace.
#pragma once
#include <span>
#include <vector>

#include "trace/shadow/shadow_segment.h"
#include "trace/tree/grow.h"

namespace relook {

/// A stored tree contradicts the scene. Throws an Error of exit code 5.
[[noreturn]] void refuse_trees();

/// Counts the rays that it shoots. Requires: the objects are where they were when the trees were made.
class ObjectRays {
 public:
  /// `objects` may be null if no ray is asked for; both outlive it.
  ObjectRays(const ObjectLevels* objects, GrowCounters& counters) : objects_(objects), counters_(counters) {}

  /// Where a ray meets the object.
  [[nodiscard]] Meeting meeting(ObjectId object, const Ray& ray);
  /// The crossings of a segment with transparent surfaces, in order. `objects`: those of the surfaces, in order, as in
  /// paths. Valid until the next call.
  [[nodiscard]] const std::vector<Crossing>& filters(std::span<const std::uint32_t> objects,
                                                     const ShadowSegment& segment);
  /// Hits found so far.
  [[nodiscard]] std::uint64_t found() const { return found_; }

 private:
  const ObjectLevels* objects_;
  GrowCounters& counters_;
  std::uint64_t found_ = 0;
  std::vector<Crossing> crossings_, of_object_;
};

}  // namespace relook
