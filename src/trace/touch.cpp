#include "trace/touch.h"

#include <cmath>

namespace relook {

bool may_meet(const Box& box, float condition, const Point& origin, const Direction& direction, float t_max) {
  if (box.isEmpty()) return false;
  constexpr double kRounding = 0x1p-16;
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) largest = std::fmax(largest, std::fabs(static_cast<double>(origin[axis])));
  const double margin = kRounding * largest * static_cast<double>(condition);
  double enter = 0, leave = static_cast<double>(t_max);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = static_cast<double>(box.min[axis]) - static_cast<double>(origin[axis]) - margin;
    const double high = static_cast<double>(box.max[axis]) - static_cast<double>(origin[axis]) + margin;
    const auto slope = static_cast<double>(direction[axis]);
    if (slope == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low / slope, b = high / slope;
    enter = std::fmax(enter, std::fmin(a, b));
    leave = std::fmin(leave, std::fmax(a, b));
  }
  return enter <= leave;
}

}  // namespace relook
