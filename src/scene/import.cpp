#include "scene/import.h"

#include "scene/gltf_check.h"
#include "scene/gltf_json.h"
#include "scene/gltf_model.h"
#include "scene/gltf_source.h"
#include "scene/gltf_textures.h"
#include "scene/gltf_unpack.h"
#include "scene/import_memory.h"

namespace relook {
namespace {

/// The bytes behind data URIs are loaded by now; their text would only burden the look document.
void drop_data_uris(Json& gltf) {
  for (const char* key : {"buffers", "images"}) {
    const auto section = gltf.find(key);
    if (section == gltf.end()) continue;
    for (Json& entry : *section) {
      const auto uri = entry.find("uri");
      if (uri != entry.end() && uri->get_ref<const std::string&>().find(':') != std::string::npos) entry.erase(uri);
    }
  }
}

/// check_document() lets rounding errors pass; from here on the fourth row is exactly 0 0 0 1.
void make_matrices_affine(Json& gltf) {
  const auto nodes = gltf.find("nodes");
  if (nodes == gltf.end()) return;
  for (Json& node : *nodes) {
    const auto matrix = node.find("matrix");
    if (matrix == node.end()) continue;
    for (const std::size_t i : {3U, 7U, 11U, 15U}) (*matrix)[i] = i == 15 ? 1 : 0;
  }
}

const Json& array_of(const Json& owner, std::string_view key) {
  static const Json empty = Json::array();
  const auto found = owner.find(key);
  return found == owner.end() ? empty : *found;
}

}  // namespace

std::vector<std::size_t> active_nodes(const Json& gltf) {
  const Json& nodes = array_of(gltf, "nodes");
  const Json& scenes = array_of(gltf, "scenes");
  std::vector<std::size_t> active;
  if (!scenes.empty()) {
    for (const Json& root : array_of(scenes.at(gltf.value("scene", std::size_t{0})), "nodes")) active.push_back(root);
  } else {
    std::vector<bool> is_child(nodes.size(), false);
    for (const Json& node : nodes)
      for (const Json& child : array_of(node, "children")) is_child.at(child) = true;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!is_child[i]) active.push_back(i);
  }
  for (std::size_t next = 0; next < active.size(); ++next)
    for (const Json& child : array_of(nodes.at(active[next]), "children")) active.push_back(child);
  return active;
}

ImportedGltf import_gltf(const std::filesystem::path& path) {
  GltfSource source = read_gltf_source(path);
  ImportedGltf imported;
  imported.file = source.file;
  check_document(source.json, source.file, imported.warnings);
  imported.files = external_files(source);
  ImportShare share;  // of what is held until the import is done; then its result is counted
  auto buffers = load_buffers(source, share);
  imported.images = load_images(source, buffers);
  GltfModel model = parse_model(source.json, std::move(buffers), source.file);
  const JsonView root(source.json, source.file);
  unpack_draco(root, model, imported.warnings, share);
  unpack_meshopt(root, model, accessors_of_scene(root, model), imported.warnings, share);
  imported.meshes = decode_meshes(model, source.file, imported.warnings, share);
  imported.instances = decode_instances(source.json, model, source.file, share);
  imported.inverse_binds = decode_skins(source.json, model, source.file, imported.warnings, share);
  imported.gltf = std::move(source.json);
  resolve_texture_sources(imported.gltf, imported.images, imported.warnings);
  drop_data_uris(imported.gltf);
  make_matrices_affine(imported.gltf);
  return imported;
}

}  // namespace relook
