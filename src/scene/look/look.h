// The look document: the glTF JSON with names for indices and every default filled in, so that every property that can
// be edited has one address. Its members are the sections below, objects keyed by name, and `scene` and `extensions`.
// Made from an imported file or read from a cache; edit/ patches it, compile/ turns it into a Scene.
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
  Json look;                                                  // see README.md, "The look document"
  // glTF index -> name, per section (numbers as names). Of lights those of KHR_lights_punctual; then, if there are any
  // of EXT_lights_area, a gap "" and these.
  std::array<std::vector<std::string>, kSectionCount> order;
  std::map<std::string, std::vector<Transform>, std::less<>> instances;  // node name -> EXT_mesh_gpu_instancing
  std::map<std::string, std::vector<Transform>, std::less<>> inverse_binds;  // skin name -> a matrix a joint
  Json cameras;  // glTF cameras by name: {"node": name or "", "camera": {...}, "index": glTF's}
  std::shared_ptr<Assets> assets;
  std::string file;  // for messages
};

/// Throws LookError for what the importer does not check.
[[nodiscard]] LookDocument make_look_document(ImportedGltf imported);

/// Fills the defaults of one value of a section in place (an added material, node, ...). Idempotent.
void fill_defaults(Section section, Json& value);

/// --lights auto: adds lights and nodes `key`, `fill` and `rim`, which shine from outside, and a `lamp` at the camera
/// if it stands in a closed room; under Integrator::path a grey environment where there is none. Returns a sentence
/// about the lamp, or "" if there is none.
[[nodiscard]] std::string add_auto_lights(LookDocument& document, const Camera& camera,
                                          Integrator integrator = Integrator::whitted);

/// Resolves --camera NAME | auto | EYE:TARGET:FOV ("" takes the first camera) at a resolution in pixels. Throws
/// InputError when the scene has no such camera or nothing to frame, UsageError for a wrong EYE:TARGET:FOV.
[[nodiscard]] Camera choose_camera(const LookDocument& document, std::string_view choice, std::uint32_t width,
                                   std::uint32_t height);

}  // namespace relook
