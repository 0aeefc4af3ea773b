#include "compare/plane.h"

#include "base/error.h"

namespace relook {

Plane filter_rows(const Plane& plane, std::span<const float> kernel) {
  require(plane.width >= kernel.size(), "a filter fits into its plane");
  Plane filtered(plane.width - kernel.size() + 1, plane.height);
  for (std::size_t y = 0; y < filtered.height; ++y) {
    float* out = filtered.values.data() + y * filtered.width;
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const float* in = plane.values.data() + y * plane.width + tap;
      const float weight = kernel[tap];
      for (std::size_t x = 0; x < filtered.width; ++x) out[x] += weight * in[x];
    }
  }
  return filtered;
}

Plane filter_columns(const Plane& plane, std::span<const float> kernel) {
  require(plane.height >= kernel.size(), "a filter fits into its plane");
  Plane filtered(plane.width, plane.height - kernel.size() + 1);
  for (std::size_t y = 0; y < filtered.height; ++y) {
    float* out = filtered.values.data() + y * filtered.width;
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const float* in = plane.values.data() + (y + tap) * plane.width;
      const float weight = kernel[tap];
      for (std::size_t x = 0; x < filtered.width; ++x) out[x] += weight * in[x];
    }
  }
  return filtered;
}

}  // namespace relook
