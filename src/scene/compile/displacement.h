// Displacement maps (Table 1 of the paper, geometrical manipulation): a mesh moved along its normals by a texture,
// object by object. The compiler limits the size, trace/ray_scene.cpp moves the vertices.
#pragma once
#include "scene/mesh.h"
#include "scene/scene.h"

namespace relook {

inline constexpr std::size_t kMostDisplacedTriangles = std::size_t{1} << 24;
/// How many triangles displacement makes of a mesh: more than kMostDisplacedTriangles is refused by the compiler.
[[nodiscard]] std::size_t displaced_triangles(const Mesh& mesh, const Displacement& displacement);

/// `mesh` subdivided and displaced, with fresh normals and bounds. The same bits on every machine. A mesh without
/// normals is displaced along averaged normals, so that no cracks open, and stays flat-shaded.
/// Requires: displaced_triangles() within its limit.
[[nodiscard]] Mesh displaced(const Mesh& mesh, const Displacement& displacement);

}  // namespace relook
