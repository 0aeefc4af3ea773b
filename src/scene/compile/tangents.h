// Tangents of a mesh that brings none: from positions, normals and one set of texture coordinates, as MikkTSpace
// defines them (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited"; glTF 2.0 section 3.7.2.1 asks for it).
// Called by trace/ray_scene.cpp for objects whose material needs a frame.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace relook {

/// In object space. Corners that share position, normal, texture coordinates and handedness share a tangent: the mean
/// over their triangles, each laid into the plane across the normal, weighted by the angle at the corner.
struct CornerTangents {
  std::vector<Imath::V4f> tangents;  // xyz unit, or zero where the texture coordinates give none; w handedness, +Y up
  std::vector<std::array<std::uint32_t, 3>> corners;  // by triangle, into `tangents`
};

/// Requires: normals, and texture coordinates of that set.
[[nodiscard]] CornerTangents derive_tangents(const Mesh& mesh, std::uint8_t texcoord);

}  // namespace relook
