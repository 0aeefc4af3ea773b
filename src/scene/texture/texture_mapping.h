// Where a texture slot is read: at a uv of the mesh, or at coordinates projected from the object-space position, if the
// slot says so (extras.relook.mapping) or the mesh has no uv for it. Portable arithmetic only. Called by
// trace/surface.cpp and displacement.
#pragma once
#include "base/portable_math.h"
#include "scene/material.h"
#include "scene/mesh.h"

namespace relook {

/// The slot's mapping; for a mesh without the uv set it wants: solid for procedural textures, planar for images.
[[nodiscard]] inline Mapping effective_mapping(const Mesh& mesh, const TextureSlot& slot) {
  if (slot.mapping != Mapping::uv || !mesh.uv[slot.texcoord].empty()) return slot.mapping;
  return slot.kind == TextureKind::procedural ? Mapping::solid : Mapping::planar;
}

/// Coordinates of an object-space position over the mesh's bounds: planar, spherical or cylindrical about `axis`.
[[nodiscard]] Point projected_coordinates(const Mesh& mesh, const Point& local, Mapping mapping, int axis);

/// Coordinates of a vertex: uv in x and y; the position itself for a solid mapping.
[[nodiscard]] inline Point vertex_coordinates(const Mesh& mesh, const TextureSlot& slot, Mapping mapping,
                                              std::uint32_t vertex) {
  if (mapping == Mapping::solid) return mesh.positions[vertex];
  if (mapping == Mapping::uv) return Point(mesh.uv[slot.texcoord][vertex].x, mesh.uv[slot.texcoord][vertex].y, 0);
  return projected_coordinates(mesh, mesh.positions[vertex], mapping, slot.axis);
}

/// Sine and cosine of the slot's rotation.
struct Rotation {
  float sine = 0, cosine = 1;
};
[[nodiscard]] inline Rotation rotation_of(const TextureSlot& slot) {
  constexpr float kTurnsPerRadian = 0.15915494F;
  if (slot.rotation == 0) return {portable_sin_turns(0), portable_sin_turns(0.25F)};  // known to the compiler
  const float turns = slot.rotation * kTurnsPerRadian;
  return {portable_sin_turns(turns), portable_sin_turns(turns + 0.25F)};
}

/// KHR_texture_transform: scale, then rotate counter-clockwise, then move.
[[nodiscard]] inline Uv transformed_uv(const TextureSlot& slot, const Point& coordinates) {
  const auto [s, c] = rotation_of(slot);
  const float x = coordinates.x * slot.scale.x, y = coordinates.y * slot.scale.y;
  return Uv(c * x + s * y + slot.offset.x, -s * x + c * y + slot.offset.y);
}

}  // namespace relook
