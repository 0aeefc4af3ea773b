// What the active scene of a glTF file reaches, and so what of a file can be wrong without harm. Used by the importer
// and by make_look_document(), which looks up glTF's arrays by section.
#pragma once
#include <array>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "scene/look/look_schema.h"

namespace relook {

/// What is used, by index into glTF's arrays. Materials of variants count as used: one edit shows them.
struct GltfUse {
  std::vector<bool> nodes, cameras, lights, meshes, skins, materials, textures, images, samplers;
  std::vector<bool> skinned_meshes;  // of a node with a skin
  struct Primitive {
    std::array<bool, 2> uv{};  // TEXCOORD_n is read by a texture of its materials
    bool is_lit = false;       // by one of them
  };
  std::vector<std::vector<Primitive>> primitives;  // by mesh
  std::vector<bool> area_lights;                   // of EXT_lights_area; `lights`: of KHR_lights_punctual

  [[nodiscard]] const std::vector<bool>& of(Section section) const;
  /// Whether a column of a primitive, or of its morph targets, counts for the picture; tangents can be derived.
  [[nodiscard]] bool reads(std::size_t mesh, std::size_t primitive, std::string_view semantic) const;
};

/// Requires: every index in `gltf` is in range and its nodes are trees. Other values may be wrong.
[[nodiscard]] GltfUse gltf_use(const Json& gltf);

/// glTF's array behind a section or the cameras; an empty one where there is none. Of lights that of
/// KHR_lights_punctual; the other is that of EXT_lights_area.
[[nodiscard]] const Json& gltf_array(const Json& gltf, Section section);
[[nodiscard]] const Json& gltf_area_lights(const Json& gltf);

}  // namespace relook
