// Displacement maps (Table 1, geometrical manipulation): a mesh moved along its normals by a texture, object by object.
#pragma once
#include "scene/mesh.h"
#include "scene/scene.h"

namespace relook {

/// `mesh` subdivided and displaced, with fresh normals and bounds. The same bits on every machine. A mesh without
/// normals is displaced along averaged normals, so that no cracks open, and stays flat-shaded.
/// Throws InputError when subdivision would make more than kMostDisplacedTriangles.
inline constexpr std::size_t kMostDisplacedTriangles = std::size_t{1} << 24;
[[nodiscard]] Mesh displaced(const Mesh& mesh, const Displacement& displacement);

}  // namespace relook
