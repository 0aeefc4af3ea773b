// LDR-FLIP: how different two images look when an observer flips between them. P. Andersson, J. Nilsson,
// T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. Fairchild: "FLIP: A Difference Evaluator for Alternating Images",
// HPG 2020. Filters as seen on a 0.7 m wide display of 3840 pixels from 0.7 m: 67 pixels a degree.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "compare/grid.h"

namespace relook {

/// What the filters see beyond a pixel, in pixels on each side.
inline constexpr std::size_t kFlipRadius = 10;

using FlipKernel = std::array<float, 2 * kFlipRadius + 1>;

/// The observer's filters, separated: contrast sensitivity (4.1 of the paper) and features (4.3).
struct FlipFilters {
  FlipKernel achromatic{}, red_green{}, blue_yellow_wide{}, blue_yellow_narrow{};  // Gaussians
  float wide_share = 0, narrow_share = 0;                                          // of the two blue-yellow ones
  FlipKernel gaussian{}, edge{}, point{};
};
[[nodiscard]] FlipFilters flip_filters();

/// Linear Rec.709 in [0, 1]: grids with kFlipRadius pixels beyond those asked for on each side.
struct RgbGrids {
  Grid r, g, b;
};

/// The error in [0, 1] of each pixel asked for, row by row. Requires grids of one size.
[[nodiscard]] std::vector<float> ldr_flip(const RgbGrids& reference, const RgbGrids& test, const FlipFilters& filters);

}  // namespace relook
