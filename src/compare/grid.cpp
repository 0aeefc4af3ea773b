#include "compare/grid.h"

#include "base/error.h"

namespace relook {

Grid filter_rows(const Grid& grid, std::span<const float> kernel) {
  require(grid.width >= kernel.size(), "a filter fits into its grid");
  Grid filtered(grid.width - kernel.size() + 1, grid.height);
  for (std::size_t y = 0; y < filtered.height; ++y) {
    float* out = filtered.values.data() + y * filtered.width;
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const float* in = grid.values.data() + y * grid.width + tap;
      const float weight = kernel[tap];
      for (std::size_t x = 0; x < filtered.width; ++x) out[x] += weight * in[x];
    }
  }
  return filtered;
}

Grid filter_columns(const Grid& grid, std::span<const float> kernel) {
  require(grid.height >= kernel.size(), "a filter fits into its grid");
  Grid filtered(grid.width, grid.height - kernel.size() + 1);
  for (std::size_t y = 0; y < filtered.height; ++y) {
    float* out = filtered.values.data() + y * filtered.width;
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const float* in = grid.values.data() + (y + tap) * grid.width;
      const float weight = kernel[tap];
      for (std::size_t x = 0; x < filtered.width; ++x) out[x] += weight * in[x];
    }
  }
  return filtered;
}

}  // namespace relook
