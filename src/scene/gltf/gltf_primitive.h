// One glTF primitive being decoded: accessors go in, numbers at the vertices that triangles name come out, checked.
// Used by gltf_mesh.cpp (what every mesh has) and gltf_deform.cpp (morph targets, joints) alone.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/check/gltf_use.h"
#include "scene/gltf/gltf_accessor.h"

namespace relook {

inline constexpr float kLargestCoordinate = 1e9F;  // products of two edges and their squares stay finite

/// Where a primitive stands, and what its decoding reads and reports to.
struct PrimitiveSource {
  const GltfModel& model;
  const GltfPrimitive& primitive;
  std::string_view file;
  std::string pointer;  // "/meshes/0/primitives/1"
  std::vector<std::string>& warnings;
  const GltfUse& use;
  std::size_t mesh = 0, number = 0;     // of the primitive in its mesh
  std::vector<std::uint32_t> vertices;  // those that triangles name, increasing: the mesh has no others

  /// `place`: "/attributes/POSITION", below the primitive. Throws InputError.
  [[noreturn]] void fail(const std::string& place, std::string_view what) const;
  void warn(const std::string& place, std::string_view what) const;
  /// tolerate() at that place.
  void forgive(const std::string& place, std::string_view what) const;
  /// Null without the attribute.
  [[nodiscard]] const GltfAccessor* accessor(std::string_view semantic) const;
  /// Whether the scene reads the attribute.
  [[nodiscard]] bool reads(std::string_view semantic) const { return use.reads(mesh, number, semantic); }
};

/// Which formats a column may have, KHR_mesh_quantization included.
struct ColumnFormat {
  std::size_t least_width, most_width;
  bool integers;             // integer components at all
  bool only_normalized;      // integers must be normalized
  bool only_signed = false;  // normals and tangents
};

[[nodiscard]] std::string attribute_place(std::string_view semantic);  // "/attributes/POSITION"

/// An accessor's numbers at the vertices that are used, all finite and at most `largest` in magnitude. `is_read`:
/// whether the scene reads the column; if not, a column with a wrong number is empty.
[[nodiscard]] std::vector<float> column_of(const PrimitiveSource& source, const GltfAccessor& accessor,
                                           const std::string& place, const ColumnFormat& format, float largest,
                                           bool is_read);
/// The same of an attribute; empty without it.
[[nodiscard]] std::vector<float> attribute(const PrimitiveSource& source, std::string_view semantic,
                                           const ColumnFormat& format, float largest);

/// Morph targets (glTF 2.0 section 3.7.2.2) of the columns that the mesh has.
void decode_targets(const PrimitiveSource& source, Mesh& mesh);
/// JOINTS_n and WEIGHTS_n (section 3.7.3.3), the weights of every vertex with the sum 1.
void decode_joints(const PrimitiveSource& source, Mesh& mesh);
/// Bytes that morph targets and joints make of a primitive with so many vertices.
[[nodiscard]] std::uint64_t deforming_bytes(const GltfPrimitive& primitive, std::uint64_t vertices);
/// The most bytes a vertex that decoding holds beside the mesh.
[[nodiscard]] std::uint64_t passing_bytes(const GltfPrimitive& primitive);

}  // namespace relook
