#include "trace/box_range.h"

#include <algorithm>
#include <cmath>

namespace relook {

Box world_bounds(const RayObject& object) {
  const Box& local = object.mesh->bounds;
  Box box;
  for (unsigned corner = 0; corner < 8 && !local.isEmpty(); ++corner) {
    const Point at((corner & 1U) != 0 ? local.max.x : local.min.x, (corner & 2U) != 0 ? local.max.y : local.min.y,
                   (corner & 4U) != 0 ? local.max.z : local.min.z);
    box.extendBy(at * object.to_world);
  }
  if (box.isEmpty()) return box;
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max(largest, std::max(std::fabs(box.min[axis]), std::fabs(box.max[axis])));
  // The object's offset knows how large the numbers are that cancel on the way to the world.
  const float margin = std::max(0x1p-16F * largest, 8 * object.offset) * object.condition;
  const Point around(margin, margin, margin);
  return Box(box.min - around, box.max + around);
}

std::optional<SegmentRange> range_in(const Box& box, float condition, const Point& origin, const Direction& direction,
                                     float t_max) {
  if (box.isEmpty()) return std::nullopt;
  constexpr double kRounding = 0x1p-16;
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::fabs(static_cast<double>(origin[axis])));
  const double margin = kRounding * largest * static_cast<double>(condition);
  SegmentRange range{0, static_cast<double>(t_max)};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = static_cast<double>(box.min[axis]) - static_cast<double>(origin[axis]) - margin;
    const double high = static_cast<double>(box.max[axis]) - static_cast<double>(origin[axis]) + margin;
    const auto slope = static_cast<double>(direction[axis]);
    if (slope == 0) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    const double a = low / slope, b = high / slope;
    range.enter = std::max(range.enter, std::min(a, b));
    range.leave = std::min(range.leave, std::max(a, b));
  }
  if (range.enter > range.leave) return std::nullopt;
  return range;
}

}  // namespace relook
