// Keeps vertices (tile_vertices.h) of a block whose terms of lights PathShader has just added; inside src/color/path.
#pragma once
#include "color/path/path_runner.h"
#include "color/path/tile_vertices.h"

namespace relook {

/// What the shader knows of a block, by node.
struct ShadedVertices {
  const TreeBlock& block;
  std::span<const Color> weights;
  std::span<const float> columns;               // of lit nodes, what programs of lights read: those of a node in a row
  std::span<const std::size_t> first_column;    // of lit nodes
  std::span<const std::uint32_t> column_count;  // likewise
  std::uint32_t samples_of_pixel;
};

/// Does a hit gather light, of whatever light there is?
[[nodiscard]] bool is_vertex(const ColorScene& scene, const RayNode& node);
/// What a hit scatters counts so much.
[[nodiscard]] inline float surface_scale(const RayNode& node) {
  return node.coverage.sees_surface() ? node.coverage.scale() : 0.0F;
}

/// Appends the vertices and rays of a block. Requires: columns of all vertices.
void keep_vertices(const ColorScene& scene, const ShadedVertices& shaded, PathRunner& runner, TileVertices& kept);

}  // namespace relook
