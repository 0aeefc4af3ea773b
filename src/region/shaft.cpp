#include "region/shaft.h"

#include <algorithm>
#include <cmath>

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

namespace {

/// The coordinate of a box that lies furthest along an axis, or against it.
double side_of(const Box& box, int axis, bool is_far) {
  return static_cast<double>(is_far ? box.max[axis] : box.min[axis]);
}
double length_of(const Box& box, int axis) { return side_of(box, axis, true) - side_of(box, axis, false); }

/// Does the first box reach further, or as far?
bool is_first_further(const Shaft& shaft, int axis, bool is_far) {
  const double first = side_of(shaft.from, axis, is_far), second = side_of(shaft.to, axis, is_far);
  return is_far ? first >= second : first <= second;
}

}  // namespace

double surface_area(const Shaft& shaft) {
  double area = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (const bool is_far : {false, true}) {
      const Box& outer = is_first_further(shaft, axis, is_far) ? shaft.from : shaft.to;
      area += length_of(outer, a) * length_of(outer, b);
    }
    // Planes along the axis: where one box reaches further on one side and the other on the next, the edges between
    // these sides span a trapezoid.
    for (const bool far_a : {false, true})
      for (const bool far_b : {false, true}) {
        if (is_first_further(shaft, a, far_a) == is_first_further(shaft, b, far_b)) continue;
        const double height = std::hypot(side_of(shaft.to, a, far_a) - side_of(shaft.from, a, far_a),
                                         side_of(shaft.to, b, far_b) - side_of(shaft.from, b, far_b));
        area += (length_of(shaft.from, axis) + length_of(shaft.to, axis)) / 2 * height;
      }
  }
  return area;
}

}  // namespace relook
