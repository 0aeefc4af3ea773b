// glTF 2.0 import (.gltf, .glb) of files that may be wrong or hostile. Structure and values are checked, in 64-bit
// arithmetic, before tinygltf parses the geometry; what only the data shows is checked as it is decoded. Files are read
// below the scene's folder or the roots (import_rules.h) alone.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "scene/mesh.h"

namespace relook {

/// A glTF file, checked: the JSON is valid in every index and number that look documents and the compiler use.
struct ImportedGltf {
  std::string file;                     // as named by the user, for messages
  Json gltf;                            // the document
  /// Per glTF mesh, per primitive. Points, lines and empty primitives are left out (warned about).
  std::vector<std::vector<Mesh>> meshes;
  std::vector<EncodedImage> images;     // per glTF image; name not yet set
  /// Per glTF node: local matrices of EXT_mesh_gpu_instancing, empty without the extension.
  std::vector<std::vector<Transform>> instances;
  /// Per glTF skin, per joint; empty for skins that the scene cannot show.
  std::vector<std::vector<Transform>> inverse_binds;
  std::vector<std::filesystem::path> files;  // that the scene file names
  std::vector<std::string> warnings;    // optional extensions ignored, primitives left out, ...
};

/// glTF indices of the nodes of the active scene, parents before children. Requires a checked document, whose nodes are
/// trees.
[[nodiscard]] std::vector<std::size_t> active_nodes(const Json& gltf);

/// Reads and checks a scene file. Throws InputError{file, pointer or "byte N", ...}.
[[nodiscard]] ImportedGltf import_gltf(const std::filesystem::path& path);

}  // namespace relook
