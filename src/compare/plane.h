// One channel of a frame or of a part of it, and separable filters over it: what the perceptual metrics are made of.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace relook {

struct Plane {
  std::size_t width = 0, height = 0;
  std::vector<float> values;  // [height * width], row 0 on top
  Plane() = default;
  Plane(std::size_t plane_width, std::size_t plane_height)
      : width(plane_width), height(plane_height), values(plane_width * plane_height) {}
};

/// Both give the part of the plane where the kernel fits: kernel.size() - 1 columns, or rows, fewer.
/// Requires: a plane at least as wide, or as high, as the kernel is long. Kernels are correlated, not mirrored.
[[nodiscard]] Plane filter_rows(const Plane& plane, std::span<const float> kernel);
[[nodiscard]] Plane filter_columns(const Plane& plane, std::span<const float> kernel);

}  // namespace relook
