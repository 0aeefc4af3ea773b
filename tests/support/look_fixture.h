// A small scene made in memory, for tests of look documents, edits and classes: no files, no images to decode.
#pragma once
#include <string>

#include "edit/apply.h"
#include "scene/compile/state.h"
#include "scene/look/look.h"

namespace relook {

/// A unit square in the xz plane, two triangles, with uv.
[[nodiscard]] Mesh square_mesh();

/// Materials Gold, Glass, Mirror, Phong, Cut; textures Wood (image), Marble (procedural); meshes Ball, Slab, Pair (two
/// primitives); nodes Group > {Sphere, Arm > Hand}, Floor, Window, Both, Lamp, Sun, Rig > Eye (a camera).
[[nodiscard]] ImportedGltf small_gltf();

/// Pyramids for the images of small_gltf().
[[nodiscard]] std::shared_ptr<PyramidStore> small_pyramids();

/// The scene compiled, seen by camera Eye.
[[nodiscard]] SceneState small_state(Integrator integrator = Integrator::whitted);

/// One operation as JSON text, as in a journal; `where` is "/edit/<index>".
[[nodiscard]] Edit edit_of(const std::string& json_array);
/// Applies an edit written as JSON.
SceneDelta apply_json(SceneState& state, const std::string& json_array);
/// The message of the InputError that `body` throws; "" if it throws none.
template <class Body>
[[nodiscard]] std::string message_of(const Body& body) {
  try {
    body();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// Everything living in a scene as text, by names, so that scenes compiled in different orders compare.
[[nodiscard]] std::string scene_text(const Scene& scene);

}  // namespace relook
