#include "region/shaft.h"

#include <algorithm>

namespace relook {
namespace {

/// The values of t in [enter, leave] for which all inequalities so far hold.
struct Range {
  double enter = 0, leave = 1;
  /// Keeps the t with value + t * slope <= 0.
  void clip(double value, double slope) {
    if (slope > 0)
      leave = std::min(leave, -value / slope);
    else if (slope < 0)
      enter = std::max(enter, -value / slope);
    else if (value > 0)
      leave = -1;
  }
};

/// Is `box` outside of the box around the shaft?
bool is_clear_of_bounds(const Shaft& shaft, const Box& box) {
  for (int axis = 0; axis < 3; ++axis)
    if (box.max[axis] < std::min(shaft.from.min[axis], shaft.to.min[axis]) ||
        box.min[axis] > std::max(shaft.from.max[axis], shaft.to.max[axis]))
      return true;
  return false;
}

}  // namespace

Shaft extruded(const Box& from, const Box& directions, float length) {
  return {from, Box(from.min + directions.min * length, from.max + directions.max * length)};
}

bool touches(const Shaft& shaft, const Box& box) {
  if (is_clear_of_bounds(shaft, box)) return false;
  Range range;
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<double>(shaft.from.min[axis]), high = static_cast<double>(shaft.from.max[axis]);
    range.clip(low - static_cast<double>(box.max[axis]), static_cast<double>(shaft.to.min[axis]) - low);
    range.clip(static_cast<double>(box.min[axis]) - high, high - static_cast<double>(shaft.to.max[axis]));
  }
  return range.enter <= range.leave;
}

}  // namespace relook
