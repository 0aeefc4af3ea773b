// Geometry as a binary glTF file (glTF 2.0 section 4): the way back of import_gltf.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/files.h"
#include "scene/mesh.h"

namespace relook {

/// A glTF mesh to write.
struct MeshToWrite {
  std::string name;                     // printable, distinct
  std::size_t primitive_count = 0;      // of the glTF mesh; those without triangles come back as a point, to be ignored
  std::vector<const Mesh*> primitives;  // those with triangles, by rising Mesh::primitive
};

/// A file with these meshes, without nodes, materials and images. import_gltf() reads the same bits of every column.
/// Throws InputError when it would pass the 4 GB of the format.
[[nodiscard]] Bytes glb_of(std::span<const MeshToWrite> meshes);

}  // namespace relook
