#include "trace/touch.h"

#include "trace/box_range.h"

namespace relook {

bool may_meet(const Box& box, float condition, const Point& origin, const Direction& direction, float t_max) {
  return range_in(box, condition, origin, direction, t_max).has_value();
}

}  // namespace relook
