// Which segments of ray trees a change of the scene may touch, told by the branches that lead to them: what tunnels
// (paper 3.4) find out, and what ray tests are then confined to.
#pragma once
#include <algorithm>
#include <vector>

#include "base/math.h"
#include "trace/tree/history.h"
#include "trace/tree/light_set.h"

namespace relook {

/// Segments of one history that a change may touch: the rays that lead there, the shadow segments from there to some
/// lights, or only segments further down.
struct Touch {
  History history;
  bool ray = false, below = false;
  LightSet open = {}, blocked = {};  // lights: of the segments that reach them, of those that do not
  [[nodiscard]] bool touches(bool is_blocked, std::size_t light) const {
    return (is_blocked ? blocked : open).has(light);
  }
};
/// Increasing by history; a touch of a section comes with those of its ancestors.
using Touches = std::vector<Touch>;

/// Boxes around a selection, widened by the rounding of its own coordinates, and how much its placement stretches
/// rounding: with them a single segment is ruled out before it costs a ray test.
struct SelectionBounds {
  Box moved, shadows_before, shadows_after;  // as the top levels of RayChange
  float condition = 1;
};
/// May the segment from `origin` along `direction`, from t_min as far as t_max, meet something in the box? Errs to
/// true.
[[nodiscard]] bool may_meet(const Box& box, float condition, const Point& origin, const Direction& direction,
                            float t_min, float t_max);

/// The touch of a history, or null.
[[nodiscard]] inline const Touch* touch_of(const Touches& touches, History history) {
  const auto it = std::ranges::find(touches, history, &Touch::history);
  return it == touches.end() ? nullptr : &*it;
}

}  // namespace relook
