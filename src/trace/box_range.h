// Boxes around objects and segments, up to rounding: what they say of a hit holds for the bits that tracing gives.
#pragma once
#include <optional>

#include "base/math.h"
#include "trace/ray_scene.h"

namespace relook {

/// A box that holds every hit on the object, world space.
[[nodiscard]] Box world_bounds(const RayObject& object);

/// Where a segment is in a box, in lengths of its direction.
struct SegmentRange {
  double enter = 0, leave = 0;
};
/// None: it misses the box. Errs to more. `condition`: how much the placement of what is in the box stretches rounding.
[[nodiscard]] std::optional<SegmentRange> range_in(const Box& box, float condition, const Point& origin,
                                                   const Direction& direction, float t_max);

}  // namespace relook
