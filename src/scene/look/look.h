// The look document, in which every editable property has one address: the glTF JSON with names for indices and every
// default filled in. Objects keyed by name: materials, textures, images, samplers, meshes, lights, nodes; plus `scene`.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/json.h"
#include "scene/camera.h"
#include "scene/gltf/import.h"
#include "scene/scene.h"

namespace relook {

/// The arrays of glTF that the look document keys by name.
enum class Section : std::uint8_t { materials, textures, images, samplers, meshes, lights, nodes, skins };
inline constexpr std::size_t kSectionCount = 8;
[[nodiscard]] std::string_view section_name(Section section);

/// A look document with what it refers to.
struct LookDocument {
  Json look;                                                  // see README, "The look document"
  std::array<std::vector<std::string>, kSectionCount> order;  // glTF index -> name, per section (numbers as names)
  std::map<std::string, std::vector<Transform>, std::less<>> instances;  // node name -> EXT_mesh_gpu_instancing
  std::map<std::string, std::vector<Transform>, std::less<>> inverse_binds;  // skin name -> a matrix a joint
  Json cameras;  // glTF cameras by name: {"node": name, "camera": {...}}
  std::shared_ptr<Assets> assets;
  std::string file;  // for messages
};

[[nodiscard]] LookDocument make_look_document(ImportedGltf imported);  // LookError: what the importer cannot tell

/// Fills the defaults of one value of a section in place (an added material, node, ...). Idempotent.
void fill_defaults(Section section, Json& value);

/// --lights auto: adds lights and nodes `key`, `fill` and `rim`, which shine from outside, and a `lamp` at a camera in a
/// closed room, which is said in a sentence; "" without.
[[nodiscard]] std::string add_auto_lights(LookDocument& document, const Camera& camera);

/// Resolves --camera NAME | auto | EYE:TARGET:FOV ("" takes the only or first camera) at a resolution in pixels.
/// Throws InputError naming the flag when the scene has no camera.
[[nodiscard]] Camera choose_camera(const LookDocument& document, std::string_view choice, std::uint32_t width,
                                   std::uint32_t height);

}  // namespace relook
