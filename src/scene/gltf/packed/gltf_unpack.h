// Compressed meshes (KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_meshopt_compression) made plain: what
// they hold becomes buffers, views and accessors of the model, and nothing after that knows that they were compressed.
// Counts and sizes are checked and counted against the import budget before anything is decoded (mesh_library.h). Data
// that a newer encoder wrote than the decoders know gives way, with a warning, to what the file has uncompressed.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "scene/gltf/check/gltf_use.h"
#include "scene/gltf/gltf_model.h"

namespace relook {

/// The extension of a buffer view, under either name; none without it.
[[nodiscard]] std::optional<JsonView> meshopt_extension(const JsonView& view);
/// The extension of a primitive; none without it.
[[nodiscard]] std::optional<JsonView> draco_extension(const JsonView& primitive);

/// Gives the primitives of a checked model that name Draco data its attributes and indices. Data that
/// several primitives name is decoded once. Throws InputError{file, pointer, ...}, ResourceError; not InputError for
/// data of meshes that the scene does not show: they lose their positions then, with a warning.
void unpack_draco(const JsonView& root, GltfModel& model, const GltfUse& use, std::vector<std::string>& warnings,
                  ImportShare& share);

/// An accessor that is read, and whether the scene shows what it is for.
struct ReadAccessor {
  std::size_t index;
  bool is_needed;
};

/// Unpacks the views that these accessors read; others stay as they are. A view that cannot be read and is not needed
/// stays without data, with a warning. Errors as above.
void unpack_meshopt(const JsonView& root, GltfModel& model, const std::vector<ReadAccessor>& accessors,
                    std::vector<std::string>& warnings, ImportShare& share);

/// Accessors that meshes, skins and instances read. Requires: unpack_draco() has been called.
[[nodiscard]] std::vector<ReadAccessor> accessors_of_scene(const JsonView& root, const GltfModel& model,
                                                           const GltfUse& use);
/// Accessors that animations read.
[[nodiscard]] std::vector<ReadAccessor> accessors_of_animations(const JsonView& root, const GltfModel& model);

/// How a user gets a file without the extensions.
inline constexpr std::string_view kUnpackCommand = "`gltf-transform copy IN.glb OUT.glb` writes the file uncompressed";

}  // namespace relook
