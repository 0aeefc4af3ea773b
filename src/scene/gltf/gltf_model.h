// The geometry of a glTF file as tinygltf parsed it, without tinygltf's types: buffers, views, accessors, primitives.
// Invariant: the document passed check_document(), so every index and byte range here is sound.
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/import_memory.h"
#include "base/json.h"
#include "scene/gltf/check/gltf_use.h"
#include "scene/gltf/import.h"

namespace relook {

inline constexpr std::size_t kNoIndex = std::numeric_limits<std::size_t>::max();

/// The largest number in matrices of instances and inverse binds: products with places in the world stay finite.
inline constexpr float kLargestMatrix = 1e12F;

struct GltfBufferView {
  std::size_t buffer = 0, offset = 0, length = 0;
  std::size_t stride = 0;  // bytes from element to element; 0: tightly packed
};

/// glTF's numbers for component types.
enum class Component : std::uint16_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

struct GltfAccessor {
  std::size_t view = kNoIndex;  // kNoIndex: zeros
  std::size_t offset = 0, count = 0;
  Component component = Component::f32;
  std::size_t width = 1;  // components of an element; 16 of MAT4, 0 of other matrices, which relook does not read
  bool normalized = false;
  std::size_t sparse_count = 0;  // elements replaced
  std::size_t sparse_index_view = 0, sparse_index_offset = 0;
  Component sparse_index_component = Component::u16;
  std::size_t sparse_value_view = 0, sparse_value_offset = 0;
};

using GltfAttributes = std::map<std::string, std::size_t, std::less<>>;  // semantic -> accessor

struct GltfPrimitive {
  GltfAttributes attributes;
  std::vector<GltfAttributes> targets;
  std::size_t indices = kNoIndex;  // accessor
  int mode = 4;                    // 4 triangles, 5 strip, 6 fan
};

struct GltfModel {
  std::vector<std::vector<unsigned char>> buffers;
  std::vector<GltfBufferView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<std::vector<GltfPrimitive>> meshes;
};

/// Lets tinygltf parse the geometry of a checked document. It gets `buffers` from memory and sees no file. Primitives
/// of Draco data have no indices yet (packed/gltf_unpack.h).
/// Throws InputError{file, ...} with tinygltf's own words if it refuses.
[[nodiscard]] GltfModel parse_model(const Json& gltf, std::vector<std::vector<unsigned char>> buffers,
                                    std::string_view file);

/// All triangle primitives, in order. Checks what can only be seen in the data: finite values, indices below the vertex
/// count. A column with a wrong value that nothing in the scene reads is left out, and so is a mesh. Throws
/// InputError{file, pointer, ...}, for a small file that asks for much, too.
/// `share`: takes the bytes of every column before it is made; throws ResourceError where they are not left.
[[nodiscard]] std::vector<std::vector<Mesh>> decode_meshes(const GltfModel& model, const GltfUse& use,
                                                           std::string_view file, std::vector<std::string>& warnings,
                                                           ImportShare& share);

/// Inverse bind matrices of every skin, one a joint: identities without an accessor. Checks skins as a whole. A skin
/// that no node of the active scene has gets none; nor does a skin of which the scene lacks a joint, and the nodes of
/// `gltf` lose that skin, with a warning. `share`: as above.
/// Throws InputError, ResourceError.
[[nodiscard]] std::vector<std::vector<Transform>> decode_skins(Json& gltf, const GltfModel& model,
                                                               std::string_view file,
                                                               std::vector<std::string>& warnings,
                                                               ImportShare& share);

/// EXT_mesh_gpu_instancing of every node that is used. `share`: as above. Throws InputError, ResourceError.
[[nodiscard]] std::vector<std::vector<Transform>> decode_instances(const Json& gltf, const GltfModel& model,
                                                                   const GltfUse& use, std::string_view file,
                                                                   ImportShare& share);

}  // namespace relook
