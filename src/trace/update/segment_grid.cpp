#include "trace/update/segment_grid.h"

#include <algorithm>
#include <cmath>

namespace relook {
namespace {

constexpr double kLast = 65535;
// Boxes keep away from the ends of the grid by two steps: there stands what is in no box.
constexpr double kFree = 2;
// A selection's longest side is at least this many steps, of those that a grid is made for twice as many.
constexpr double kFewestSteps = 8;
constexpr double kLargestGrid = (kLast - 2 * kFree) / (2 * kFewestSteps);  // in longest sides of a selection

constexpr GridEnds kNowhere{};

/// Of a ray, where it is in a box; false: nowhere.
bool cut(const Ray& ray, const std::array<double, 3>& low, const std::array<double, 3>& high, double& enter,
         double& leave) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const double origin = ray.origin[axis], slope = ray.direction[axis];
    if (slope == 0) {
      if (origin < low[k] || origin > high[k]) return false;
      continue;
    }
    const double a = (low[k] - origin) / slope, b = (high[k] - origin) / slope;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

}  // namespace

SegmentGrid::SegmentGrid(const Box& scene, const Box& selection) {
  const Point size = selection.size(), middle = selection.center();
  const double longest = std::max(std::max(size.x, size.y), size.z);
  if (selection.isEmpty() || !(longest > 0 && std::isfinite(longest))) return;
  Box all = scene;
  all.extendBy(selection);
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    constexpr double kAround = 0.25;  // of the scene, for what is moved out of it
    const double extent = static_cast<double>(all.max[axis]) - static_cast<double>(all.min[axis]);
    low_[k] = all.min[axis] - kAround * extent;
    high_[k] = all.max[axis] + kAround * extent;
    const double most = kLargestGrid * longest;
    if (high_[k] - low_[k] > most) {
      low_[k] = std::max(low_[k], middle[axis] - most / 2);
      high_[k] = std::min(high_[k], middle[axis] + most / 2);
    }
    // A flat scene has room above and below it, too.
    low_[k] = std::min(low_[k], selection.min[axis] - longest);
    high_[k] = std::max(high_[k], selection.max[axis] + longest);
    scale_[k] = (kLast - 2 * kFree) / (high_[k] - low_[k]);
  }
}

GridEnds SegmentGrid::ends_of(const Ray& ray) const {
  std::array<double, 6> at;
  find_steps(ray, ray.t_min, ray.t_max, at);
  // Most segments are in the grid as a whole, or leave it. What is without an end, or not a number, is not inside.
  const auto is_inside = [](double step) { return step >= kFree && step <= kLast - kFree; };
  if (!(is_inside(at[0]) && is_inside(at[1]) && is_inside(at[2]))) {
    double enter = ray.t_min, leave = ray.t_max;
    if (!cut(ray, low_, high_, enter, leave)) return kNowhere;
    find_steps(ray, enter, leave, at);
  } else if (!(is_inside(at[3]) && is_inside(at[4]) && is_inside(at[5]))) {
    double leave = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const double slope = ray.direction[axis];
      if (slope != 0) leave = std::min(leave, ((slope > 0 ? high_[k] : low_[k]) - ray.origin[axis]) / slope);
    }
    find_steps(ray, ray.t_min, leave, at);
  }
  GridEnds ends;
  for (std::size_t k = 0; k < ends.size(); ++k)
    ends[k] = static_cast<std::uint16_t>((at[k] > 0 ? std::min(at[k], kLast) : 0) + 0.5);
  return ends;
}

void SegmentGrid::find_steps(const Ray& ray, double from, double to, std::array<double, 6>& at) const {
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const double origin = (ray.origin[axis] - low_[k]) * scale_[k] + kFree, slope = ray.direction[axis] * scale_[k];
    at[k] = origin + from * slope;
    at[k + 3] = origin + to * slope;
  }
}

std::optional<GridBox> SegmentGrid::around(const Box& box, float margin) const {
  constexpr double kWider = 1;  // step: half of it for rounding to the grid, the rest for that of the tests
  GridBox steps;
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const double min = box.min[axis], max = box.max[axis];
    const double low = (min - margin - low_[k]) * scale_[k] + kFree - kWider;
    const double high = (max + margin - low_[k]) * scale_[k] + kFree + kWider;
    if (!(low > kFree + kWider && high < kLast - kFree - kWider)) return std::nullopt;
    longest = std::max(longest, high - low);
    steps.sum[k] = static_cast<float>(low + high);
    steps.size[k] = static_cast<float>(high - low);
  }
  if (longest < kFewestSteps) return std::nullopt;
  return steps;
}

}  // namespace relook
