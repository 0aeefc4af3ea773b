// Geometry and other columns as binary glTF (glTF 2.0 section 3.6, and 4: GLB): the way back of import_gltf. Used for
// geometry that a journal brings in (edit/draft) and by exports (scene/export).
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/json.h"
#include "scene/mesh.h"

namespace relook {

/// A glTF mesh to write.
struct MeshToWrite {
  std::string name;                     // printable, distinct
  std::size_t primitive_count = 0;      // of the glTF mesh; those without triangles come back as a point, to be ignored
  std::vector<const Mesh*> primitives;  // those with triangles, by rising Mesh::primitive
};

/// Appends columns of numbers to a document's /bufferViews and /accessors and to the bytes of its buffer 0.
/// import_gltf() reads the same bits of every column.
class ColumnWriter {
 public:
  /// Both outlive the writer.
  ColumnWriter(Json& gltf, Bytes& binary) : gltf_(gltf), binary_(binary) {}

  /// A buffer view for these bytes, which begin at a multiple of four. Its index.
  std::size_t add_view(BytesView bytes);
  /// The value of /meshes/N/primitives, without materials.
  [[nodiscard]] Json add_primitives(const MeshToWrite& mesh);
  /// An accessor of MAT4: inverse bind matrices.
  std::size_t add_matrices(std::span<const Transform> matrices);
  /// EXT_mesh_gpu_instancing: /attributes with TRANSLATION, ROTATION and SCALE, as near as they come to the matrices,
  /// and these themselves in _RELOOK_X, _Y and _Z (where the axes go), which import_gltf() reads before the others.
  [[nodiscard]] Json add_instances(std::span<const Transform> matrices);

 private:
  /// Tightly packed numbers, a multiple of four bytes. The accessor, where type is "SCALAR", "VEC2", ...
  template <class T>
  std::size_t add_column(const std::vector<T>& column, const char* type, int component, std::size_t count);
  template <class T>
  void add_attribute(Json& attributes, const std::string& semantic, const std::vector<T>& column, const char* type);
  std::size_t add_positions(const std::vector<Point>& positions);
  [[nodiscard]] Json add_primitive(const Mesh& mesh);
  void add_joints(Json& attributes, const Mesh& mesh);
  [[nodiscard]] Json add_target(const Mesh& mesh, const MorphTarget& target);

  Json& gltf_;
  Bytes& binary_;
};

/// A GLB file of a document whose buffer 0, if it has any, is `binary`. Throws InputError when it would pass the 4 GB
/// of the format.
[[nodiscard]] Bytes glb_file(const Json& gltf, BytesView binary);

/// A file with these meshes, without nodes, materials and images. Throws as glb_file() does.
[[nodiscard]] Bytes glb_of(std::span<const MeshToWrite> meshes);

}  // namespace relook
