// A look document as a glTF 2.0 file: the way back of import_gltf() and make_look_document(), which read from it the
// same document, name for name and bit for bit. Where the file that the document was made of is at hand, what no edit
// touched stays as it stands there: accessors, compressed meshes, foreign extensions and extras, cameras, animations,
// other scenes. Without it (a cache, files that a journal brings in) geometry is written anew. Run by `relook export`.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/look/look.h"

namespace relook {

/// A scene file, and what its look document was before any edit.
struct ExportSource {
  Json gltf;                                        // as import_gltf() leaves it
  Json as_was;                                      // as it stands in the file
  std::vector<std::vector<unsigned char>> buffers;  // empty for one without a uri, which only extensions give a meaning
  LookDocument before;                              // without assets
};
/// Reads and checks a scene file. Throws InputError, ResourceError.
[[nodiscard]] ExportSource read_export_source(const std::filesystem::path& path);

struct ExportedFile {
  std::string name;  // relative to the folder of the .gltf, named after its bytes
  std::shared_ptr<const Bytes> bytes;
};

struct ExportedScene {
  Json gltf;                         // buffer 0, if there are bytes, has no uri
  Bytes binary;                      // of buffer 0
  std::vector<ExportedFile> files;   // images
  std::vector<std::string> remarks;  // what the file has otherwise or has lost, a sentence each
};

/// `source`: of the document, or null. `folder`: for images that lie in no buffer of the source, relative to the .gltf;
/// "": they go into the binary.
[[nodiscard]] ExportedScene export_gltf(const LookDocument& document, const ExportSource* source,
                                        const std::string& folder);

/// The bytes of a .glb. Throws InputError where it would pass 4 GB.
[[nodiscard]] Bytes glb_of(const ExportedScene& scene);
/// The text of a .gltf; its binary is added to `scene.files`, in `folder`.
[[nodiscard]] std::string gltf_text(ExportedScene& scene, const std::string& folder);

/// Whether a .gltf or .glb is as an export made it: not made or changed by anything else since.
[[nodiscard]] bool is_exported_scene(BytesView file);

}  // namespace relook
