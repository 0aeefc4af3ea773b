#include "trace/tree/touch.h"

#include "trace/box_range.h"

namespace relook {

bool may_meet(const Box& box, float condition, const Point& origin, const Direction& direction, float t_min,
              float t_max) {
  const auto range = range_in(box, condition, origin, direction, t_max);
  return range && range->leave >= static_cast<double>(t_min);
}

}  // namespace relook
