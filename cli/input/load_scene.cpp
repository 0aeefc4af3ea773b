#include "input/load_scene.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "edit/apply.h"
#include "edit/journal.h"
#include "report/edit_hashes.h"
#include "scene/gltf/import.h"
#include "scene/look/look_warnings.h"

namespace relook {
namespace {

template <class T>
std::string column_hash(const std::vector<T>& values) {
  return hash128(std::as_bytes(std::span<const T>(values)));
}

/// Of what morph targets and skins bring; nothing for a mesh that has neither.
std::string deformation_hash(const Mesh& mesh) {
  std::string digests;
  for (const MorphTarget& target : mesh.targets)
    digests += column_hash(target.positions) + column_hash(target.normals) + column_hash(target.tangents);
  if (!mesh.joints.empty()) digests += column_hash(mesh.joints) + column_hash(mesh.joint_weights);
  return digests;
}

/// Hash of everything that a scene file and the files beside it contribute.
std::string content_hash(const std::string& path, const LookDocument& document) {
  std::string digests = hash128(read_file(path));
  for (const Mesh& mesh : document.assets->meshes)
    digests += column_hash(mesh.positions) + column_hash(mesh.triangles) + column_hash(mesh.normals) +
               column_hash(mesh.tangents) + column_hash(mesh.uv[0]) + column_hash(mesh.uv[1]) +
               column_hash(mesh.colors);
  for (const auto& [name, image] : document.assets->images)
    digests += name + (image.bytes ? hash128(*image.bytes) : "-");
  for (const auto& [node, matrices] : document.instances) digests += node + column_hash(matrices);
  for (const Mesh& mesh : document.assets->meshes) digests += deformation_hash(mesh);
  for (const auto& [skin, matrices] : document.inverse_binds) digests += skin + column_hash(matrices);
  return digests;
}

/// `patch_path`: where `patch` was read.
LookDocument patched(LookDocument document, std::string_view patch, const std::filesystem::path& patch_path,
                     std::vector<std::filesystem::path>& files) {
  const std::string file = patch_path.string();
  const Edit edit = parse_patch(patch, file);
  for (const std::string& name : files_of(edit)) files.push_back(patch_path.parent_path() / name);
  Camera unused;
  unused.width = unused.height = 1;
  SceneState state(std::move(document), unused, std::make_shared<PyramidStore>());
  apply_edit(state, edit, file, patch_path.parent_path());
  return std::move(state.editable_document());
}

void warn_of_choice(LoadedDocument& loaded, const Camera& camera) {
  const Json& nodes = loaded.document.look.at("nodes");
  const auto cameras =
      std::count_if(nodes.begin(), nodes.end(), [](const Json& node) { return node.contains("camera"); });
  if (cameras < 2) return;
  loaded.warnings.push_back("the scene has " + std::to_string(cameras) + " cameras: \"" + camera.name +
                            "\" is used; --camera NAME chooses another");
}

bool is_lit(const Scene& scene) {
  const Color black(0, 0, 0);
  const Environment& environment = scene.environment;
  const auto shines = [&](LightId id) { return scene.light(id).kind != LightKind::suns; };
  return std::ranges::any_of(scene.light_order, shines) || scene.ambient != black ||
         (environment.intensity > 0 && (environment.color != black || environment.image != nullptr));
}

/// What of an environment that lights is left out, as resampling makes it.
void warn_of_negative_light(LoadedScene& loaded) {
  const Scene& scene = loaded.state->scene();
  if (scene.integrator != Integrator::path || !scene.environment.image) return;
  const float share = scene.environment.image->negative_share;
  if (!(share > 0.0005F)) return;
  std::array<char, 16> percent{};
  std::snprintf(percent.data(), percent.size(), "%.1f", static_cast<double>(share) * 100);
  loaded.warnings.push_back(std::string("the environment's image has negative texels, ") + percent.data() +
                            " % of its light: they count as 0");
}

}  // namespace

LoadedDocument load_document(const std::string& path, const ViewArguments& view) {
  ImportedGltf imported = import_gltf(path);
  LoadedDocument loaded;
  loaded.warnings = imported.warnings;
  loaded.files = imported.files;
  loaded.document = make_look_document(std::move(imported));
  const bool has_patch = !view.look_patch.empty();
  const Bytes patch = has_patch ? read_input(view.look_patch) : Bytes();
  if (has_patch)
    loaded.document = patched(std::move(loaded.document), text_of(patch), input_name(view.look_patch), loaded.files);
  std::ranges::copy(look_warnings(loaded.document, view.sampling.integrator), std::back_inserter(loaded.warnings));
  std::string digests = content_hash(path, loaded.document);
  if (has_patch) digests += hash128(patch);
  if (view.auto_lights) digests += "lights auto";
  loaded.hash = hash128(bytes_of(digests));
  return loaded;
}

Camera set_up_view(LoadedDocument& loaded, const ViewArguments& view) {
  Camera camera = choose_camera(loaded.document, view.camera, view.width, view.height);
  if (view.camera.empty()) warn_of_choice(loaded, camera);
  if (view.auto_lights)
    if (std::string said = add_auto_lights(loaded.document, camera, view.sampling.integrator); !said.empty())
      loaded.warnings.push_back(std::move(said));
  return camera;
}

Camera set_up_inspection(LoadedDocument& loaded, ViewArguments view) {
  if (view.camera.empty() && loaded.document.cameras.empty()) view.camera = "auto";
  return set_up_view(loaded, view);
}

LoadedScene load_scene(const std::string& path, const ViewArguments& view) {
  LoadedDocument loaded = load_document(path, view);
  const Camera camera = set_up_view(loaded, view);
  LoadedScene scene;
  scene.hash = std::move(loaded.hash);
  scene.files = std::move(loaded.files);
  scene.warnings = std::move(loaded.warnings);
  scene.state = std::make_unique<SceneState>(std::move(loaded.document), camera, std::make_shared<PyramidStore>(),
                                             view.sampling.integrator);
  if (!is_lit(scene.state->scene()))
    throw InputError(path, "", "the scene has no light: add some with --lights auto or --look PATCH.json");
  warn_of_negative_light(scene);
  return scene;
}

}  // namespace relook
