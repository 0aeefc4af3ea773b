// End points of segments in six bytes: a grid over a box, and segments cut to it. What is told of a segment errs to
// more: it is within half a step of where the grid has it, as far as it is in the box.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "trace/tracer.h"

namespace relook {

/// Both ends, in steps of a grid, axis by axis.
using GridEnds = std::array<std::uint16_t, 6>;

/// A box in steps of a grid, as tests against segments want it: low + high and high - low, by axis.
struct GridBox {
  std::array<float, 3> sum{}, size{};
};

class SegmentGrid {
 public:
  /// Of no box: holds nothing.
  SegmentGrid() = default;
  /// Over about the `scene`, and all of the `selection`: where the scene is much larger than that, a part of it around
  /// the selection, so that steps are small beside it.
  SegmentGrid(const Box& scene, const Box& selection);

  [[nodiscard]] bool empty() const { return scale_[0] == 0; }
  /// The ends of what is in the box of a ray that starts at t_min. Where nothing is, two points that no box of the grid
  /// reaches.
  [[nodiscard]] GridEnds ends_of(const Ray& ray) const;
  /// Around all segments of the grid that may touch the box, if it is `margin` wider on all sides; none: the box is not
  /// in the grid as a whole, or too small for its steps. `margin`: metres.
  [[nodiscard]] std::optional<GridBox> around(const Box& box, float margin) const;

 private:
  /// Where a ray is, in steps, at two places.
  void find_steps(const Ray& ray, double from, double to, std::array<double, 6>& at) const;

  std::array<double, 3> low_{}, high_{};  // metres
  std::array<double, 3> scale_{};         // steps a metre
};

}  // namespace relook
