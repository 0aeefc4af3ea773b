// Where a texture slot is read: at a uv of the mesh, or at coordinates projected from the object-space position, if the
// slot says so (extras.relook.mapping) or the mesh has no uv for it. Portable arithmetic only. Called by
// trace/surface.cpp and displacement.
#pragma once
#include "scene/material.h"
#include "scene/mesh.h"

namespace relook {

/// The slot's mapping; for a mesh without the uv set it wants: solid for procedural textures, planar for images.
[[nodiscard]] Mapping effective_mapping(const Mesh& mesh, const TextureSlot& slot);

/// Coordinates of an object-space position over the mesh's bounds: planar, spherical or cylindrical about `axis`.
[[nodiscard]] Point projected_coordinates(const Mesh& mesh, const Point& local, Mapping mapping, int axis);

/// Coordinates of a vertex: uv in x and y; the position itself for a solid mapping.
[[nodiscard]] Point vertex_coordinates(const Mesh& mesh, const TextureSlot& slot, Mapping mapping,
                                       std::uint32_t vertex);

/// Sine and cosine of the slot's rotation.
struct Rotation {
  float sine = 0, cosine = 1;
};
[[nodiscard]] Rotation rotation_of(const TextureSlot& slot);

/// KHR_texture_transform: scale, then rotate counter-clockwise, then move.
[[nodiscard]] Uv transformed_uv(const TextureSlot& slot, const Point& coordinates);

}  // namespace relook
