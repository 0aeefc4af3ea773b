// Samples of a tile: which pixel, where in it, and the primary ray. Fixed positions, no randomness.
#pragma once
#include "engine/image.h"
#include "scene/camera.h"
#include "trace/tree_block.h"

namespace relook {

/// Number of samples of a tile.
[[nodiscard]] inline std::uint32_t sample_count(const TileRect& rect, const ViewOptions& view) {
  return rect.pixels() * view.samples;
}
/// Index of a tile-local pixel in the frame.
[[nodiscard]] inline std::size_t frame_index(const TileRect& rect, std::uint32_t pixel, std::uint32_t frame_width) {
  const std::uint32_t width = rect.x1 - rect.x0;
  return std::size_t{rect.y0 + pixel / width} * frame_width + rect.x0 + pixel % width;
}
/// The primary ray of sample `sample` of a tile.
[[nodiscard]] SpawnedRay primary_ray(const Camera& camera, const ViewOptions& view, const TileRect& rect,
                                     std::uint32_t sample);
/// A pixel from its samples: their sum in order, divided by their number.
[[nodiscard]] Rgba pixel_color(const Rgba* samples, std::uint32_t count);

}  // namespace relook
