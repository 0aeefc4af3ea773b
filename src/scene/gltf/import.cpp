#include "scene/gltf/import.h"

#include <algorithm>
#include <iterator>

#include "base/import_memory.h"
#include "scene/gltf/check/gltf_check.h"
#include "scene/gltf/check/gltf_use.h"
#include "scene/gltf/check/gltf_values.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/gltf_model.h"
#include "scene/gltf/gltf_source.h"
#include "scene/gltf/gltf_specular_glossiness.h"
#include "scene/gltf/gltf_textures.h"
#include "scene/gltf/import_rules.h"
#include "scene/gltf/packed/gltf_unpack.h"

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

/// Textures that nothing shows lose an image that is not there.
void drop_missing_images(const std::vector<EncodedImage>& images, const GltfUse& use, Json& gltf) {
  for (std::size_t i = 0; i < use.textures.size(); ++i) {
    Json& texture = gltf["textures"][i];
    const auto source = texture.find("source");
    if (use.textures[i] || source == texture.end()) continue;
    const auto image = source->get<std::size_t>();
    if (!images[image].bytes && !use.images[image]) texture.erase(source);
  }
}

constexpr std::size_t kNoParent = SIZE_MAX;

std::vector<std::size_t> parents_of(const Json& gltf) {
  const Json& nodes = array_or_empty(gltf, "nodes");
  std::vector<std::size_t> parents(nodes.size(), kNoParent);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const Json& child : array_or_empty(nodes[i], "children")) parents.at(child) = i;
  return parents;
}

/// Tolerates, or refuses where imports are strict, roots of the active scene that have a parent or are named twice.
void check_roots(const Json& gltf, std::string_view file, std::vector<std::string>& warnings) {
  const Json& scenes = array_or_empty(gltf, "scenes");
  if (scenes.empty()) return;
  const std::size_t scene = gltf.value("scene", std::size_t{0});
  const std::vector<std::size_t> parents = parents_of(gltf);
  std::vector<bool> is_named(parents.size());
  const Json& roots = array_or_empty(scenes.at(scene), "nodes");
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const auto node = roots[i].get<std::size_t>();
    const std::string place = "/scenes/" + std::to_string(scene) + "/nodes/" + std::to_string(i);
    if (is_named[node]) tolerate(file, place, "names node " + std::to_string(node) + " twice", warnings);
    if (parents[node] != kNoParent)
      tolerate(file, place, "node " + std::to_string(node) + " is no root: it is a child of node " +
                                std::to_string(parents[node]), warnings);
    is_named[node] = true;
  }
}

}  // namespace

std::vector<std::size_t> active_nodes(const Json& gltf) {
  const Json& nodes = array_or_empty(gltf, "nodes");
  const Json& scenes = array_or_empty(gltf, "scenes");
  const std::vector<std::size_t> parents = parents_of(gltf);
  std::vector<std::size_t> roots;
  if (!scenes.empty()) {
    const Json& scene = scenes.at(gltf.value("scene", std::size_t{0}));
    for (const Json& root : array_or_empty(scene, "nodes")) roots.push_back(root);
  } else {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (parents[i] == kNoParent) roots.push_back(i);
  }
  std::vector<std::size_t> active;
  std::vector<bool> is_active(nodes.size());
  const auto add = [&](std::size_t node) {
    if (is_active[node]) return;
    is_active[node] = true;
    active.push_back(node);
  };
  const auto add_descendants = [&] {
    for (std::size_t next = 0; next < active.size(); ++next)
      for (const Json& child : array_or_empty(nodes.at(active[next]), "children")) add(child);
  };
  for (const std::size_t root : roots) add(root);
  add_descendants();
  // A root that is the child of an active node stands below it.
  const std::vector<bool> reached = std::move(is_active);
  std::erase_if(roots, [&](std::size_t root) { return parents[root] != kNoParent && reached[parents[root]]; });
  is_active.assign(nodes.size(), false);
  active.clear();
  for (const std::size_t root : roots) add(root);
  add_descendants();
  return active;
}

ImportedGltf import_gltf(const std::filesystem::path& path) {
  GltfSource source = read_gltf_source(path);
  ImportedGltf imported;
  imported.file = source.file;
  check_document(source.json, source.file, imported.warnings);
  check_roots(source.json, source.file, imported.warnings);
  const GltfUse use = gltf_use(source.json);
  check_gltf_values(source.json, use, source.file, imported.warnings);
  imported.files = external_files(source);
  ImportShare share;  // of what is held until the import is done; then its result is counted
  auto buffers = load_buffers(source, share);
  std::ranges::move(source.warnings, std::back_inserter(imported.warnings));
  imported.images = load_images(source, buffers, use.images, imported.warnings);
  resolve_texture_sources(source.json, imported.images, imported.warnings);
  drop_missing_images(imported.images, use, source.json);
  convert_specular_glossiness(source.json, imported.images, source.file, imported.warnings, share);
  GltfModel model = parse_model(source.json, std::move(buffers), source.file);
  const JsonView root(source.json, source.file);
  unpack_draco(root, model, use, imported.warnings, share);
  unpack_meshopt(root, model, accessors_of_scene(root, model, use), imported.warnings, share);
  imported.meshes = decode_meshes(model, use, source.file, imported.warnings, share);
  imported.instances = decode_instances(source.json, model, use, source.file, share);
  imported.inverse_binds = decode_skins(source.json, model, source.file, imported.warnings, share);
  imported.gltf = std::move(source.json);
  drop_data_uris(imported.gltf);
  return imported;
}

}  // namespace relook
