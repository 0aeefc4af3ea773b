// Which segments of ray trees a change of the scene may touch, told by the branches that lead to them: what tunnels
// (paper 3.4) find out, and what ray tests are then confined to.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "trace/tree/ray_path.h"

namespace relook {

/// The branches from the eye to a node, as one number: 0 the eye, 1 the hit of the primary ray, 4 h + 1 + branch a
/// child of h; where colours part, the three refracted rays share the number of one. Histories that would leave 28 bits
/// are their parent's: such a section encloses all that is below it.
using History = std::uint32_t;
inline constexpr History kEye = 0, kPrimary = 1;
[[nodiscard]] inline History child_of(History parent, Branch branch) {
  const Branch kind = branch >= Branch::refracted_red && branch <= Branch::refracted_blue ? Branch::refraction : branch;
  const History child = 4 * parent + 1 + static_cast<History>(kind);
  return child < (1U << 28) ? child : parent;
}
[[nodiscard]] inline History parent_of(History history) { return (history - 1) / 4; }
[[nodiscard]] inline bool is_folded(History history) { return child_of(history, Branch::transparency) == history; }

/// A bit for a place in the light order; all from the 32nd on share the last.
[[nodiscard]] inline std::uint32_t light_bit(std::size_t light) { return 1U << (light < 31 ? light : 31); }

/// Segments of one history that a change may touch: the rays that lead there, the shadow segments from there to some
/// lights, or only segments further down.
struct Touch {
  History history = kEye;
  bool ray = false, below = false;
  std::uint32_t open = 0, blocked = 0;  // lights: of the segments that reach them, of those that do not
  [[nodiscard]] bool touches(bool is_blocked, std::size_t light) const {
    return ((is_blocked ? blocked : open) & light_bit(light)) != 0;
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
