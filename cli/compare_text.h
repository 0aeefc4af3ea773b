// What `relook compare` says of frames: lines for people.
#pragma once
#include <string>
#include <vector>

#include "compare/frame_comparison.h"

namespace relook {

/// A number with four significant digits.
[[nodiscard]] std::string short_number(double value);

/// "NAME: 3 of 1024 pixels differ, max error 0.25, RMS error 0.001".
[[nodiscard]] std::string difference_text(const std::string& name, const FrameDifference& difference);

/// A line for the frame and one for each further layer that differs.
[[nodiscard]] std::vector<std::string> comparison_text(const std::string& name, const FrameComparison& comparison);

/// "; other ids in 3 pixels; only in the first: A B; uint in one only: C"; "" without anything of that.
[[nodiscard]] std::string beyond_figures(const LayerDifference& layer);

[[nodiscard]] std::size_t layers_different(const FrameComparison& comparison);

}  // namespace relook
