// The bytes of a glTF file and of everything it refers to: GLB framing (glTF 2.0 section 4), JSON text, data URIs and
// files below the scene's folder or the roots (import_rules.h). Nothing here trusts a length. Called by import.cpp and
// gltf_animation.cpp; reports and hashes of edits (report/) ask which files a scene names.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/import_memory.h"
#include "base/json.h"
#include "scene/mesh.h"

namespace relook {

/// A scene file, taken apart.
struct GltfSource {
  std::string file;              // as named by the user, for messages
  std::filesystem::path folder;  // external files lie below it
  bool is_glb = false;
  Json json;
  bool has_binary_chunk = false;
  Bytes binary_chunk;
  std::vector<std::string> warnings;  // of its framing
};

/// Throws InputError{file, "byte N" or pointer, ...}.
[[nodiscard]] GltfSource read_gltf_source(const std::filesystem::path& path);

/// Every buffer's bytes, exactly byteLength of them, or none for a placeholder without a uri. Takes the binary chunk
/// out of `source`. Requires: /buffers passed check_data_layout().
[[nodiscard]] std::vector<std::vector<unsigned char>> load_buffers(GltfSource& source, ImportShare& share);

/// The encoded bytes of every image, none for an image without uri and buffer view, or whose file is missing though
/// `used` (by image) does not name it. Requires: /images and /bufferViews passed their checks.
[[nodiscard]] std::vector<EncodedImage> load_images(const GltfSource& source,
                                                    const std::vector<std::vector<unsigned char>>& buffers,
                                                    const std::vector<bool>& used, std::vector<std::string>& warnings);

/// The files that a scene's buffers and images name, as far as they are there and lie where they may.
[[nodiscard]] std::vector<std::filesystem::path> external_files(const GltfSource& source);

/// "%20" to " ". Throws InputError{file, where, ...} on a bad escape.
[[nodiscard]] std::string percent_decoded(std::string_view uri, std::string_view file, std::string_view where);

}  // namespace relook
