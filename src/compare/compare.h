// How two frames differ: bit by bit, with the size of the differences.
#pragma once
#include <cstdint>

#include "base/json.h"
#include "frame/frame.h"

namespace relook {

struct FrameDifference {
  std::uint64_t pixels_compared = 0;
  std::uint64_t pixels_different = 0;   // at least one channel with other bits
  double max_error = 0, rms_error = 0;  // over all channels; infinite when a difference is not finite
  FrameDifference& operator+=(const FrameDifference& other);

  double squares = 0;  // sum of squared differences, of 4 * pixels_compared channels
};

/// Requires: frames of one size.
[[nodiscard]] FrameDifference compare_frames(const Frame& a, const Frame& b);
/// `percent` of the tiles, the same ones for the same `round` and others for the next; 100: all. Over as many rounds as
/// there are tiles, each tile has its turn.
[[nodiscard]] FrameDifference compare_frames(const Frame& a, const Frame& b, double percent, std::size_t round = 0);

/// Members pixels_compared, pixels_different, max_error, rms_error (null when infinite).
[[nodiscard]] Json difference_json(const FrameDifference& difference);

}  // namespace relook
