// One channel of a frame or of a part of it, and separable filters over it: what the perceptual metrics are made of.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace relook {

struct Grid {
  std::size_t width = 0, height = 0;
  std::vector<float> values;  // [height * width], row 0 on top
  Grid() = default;
  Grid(std::size_t grid_width, std::size_t grid_height)
      : width(grid_width), height(grid_height), values(grid_width * grid_height) {}
};

/// Both give the part of the grid where the kernel fits: kernel.size() - 1 columns, or rows, fewer.
/// Requires: a grid at least as wide, or as high, as the kernel is long. Kernels are correlated, not mirrored.
[[nodiscard]] Grid filter_rows(const Grid& grid, std::span<const float> kernel);
[[nodiscard]] Grid filter_columns(const Grid& grid, std::span<const float> kernel);

}  // namespace relook
