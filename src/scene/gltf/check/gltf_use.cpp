#include "scene/gltf/check/gltf_use.h"

#include <functional>

#include "base/error.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/import.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

const Json& object_in(const Json& owner, std::string_view key) {
  static const Json empty = Json::object();
  if (!owner.is_object()) return empty;
  const auto found = owner.find(key);
  return found == owner.end() || !found->is_object() ? empty : *found;
}

/// The index that `owner`'s member is, or SIZE_MAX.
std::size_t index_in(const Json& owner, std::string_view key, std::size_t count) {
  const auto found = owner.find(key);
  if (found == owner.end() || !found->is_number_unsigned()) return SIZE_MAX;
  const auto index = found->get<std::size_t>();
  return index < count ? index : SIZE_MAX;
}

/// Marks the thing of that index.
std::size_t mark(const Json& owner, std::string_view key, std::vector<bool>& used) {
  const std::size_t index = index_in(owner, key, used.size());
  if (index != SIZE_MAX) used[index] = true;
  return index;
}

/// The same for a member of extras.relook, which may say the name.
void mark_named(const Json& owner, std::string_view key, const Json& things, std::vector<bool>& used) {
  if (mark(owner, key, used) != SIZE_MAX) return;
  const auto name = owner.find(key);
  if (name == owner.end() || !name->is_string()) return;
  for (std::size_t i = 0; i < things.size(); ++i)
    if (things[i].is_object() && things[i].contains("name") && things[i]["name"] == *name) used[i] = true;
}

/// Calls visit(info) for the textureInfo objects below a value.
void for_each_slot(const Schema& schema, const Json& value, const std::function<void(const Json&)>& visit) {
  for (const SchemaField& field : schema.fields) {
    if (field.kind != FieldKind::object) continue;
    const Json& inner = object_in(value, field.key);
    if (inner.empty()) continue;
    const bool is_slot = !field.inner->fields.empty() && field.inner->fields.front().target == Target::textures &&
                         field.inner->fields.front().key == "index";
    if (is_slot)
      visit(inner);
    else
      for_each_slot(*field.inner, inner, visit);
  }
}

/// The uv set that a slot reads, if it is one of the two.
void mark_uv(const Json& info, std::array<bool, 2>& uv) {
  const Json& transform = object_in(object_in(info, "extensions"), "KHR_texture_transform");
  const Json* set = nullptr;
  for (const Json* owner : {&info, &transform})
    if (const auto found = owner->find("texCoord"); found != owner->end()) set = &*found;
  const std::size_t index = set != nullptr && set->is_number_unsigned() ? set->get<std::size_t>() : 0;
  if (index < uv.size()) uv[index] = true;
}

/// The uv sets that the textures of each material read.
std::vector<std::array<bool, 2>> uv_sets(const Json& materials) {
  std::vector<std::array<bool, 2>> sets(materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i)
    for_each_slot(file_material_schema(), materials[i], [&](const Json& info) { mark_uv(info, sets[i]); });
  return sets;
}

class Reach {
 public:
  explicit Reach(const Json& gltf) : gltf_(gltf) {
    for (const auto& [section, used] : sections()) used->resize(gltf_array(gltf, section).size());
    use_.cameras.resize(array_or_empty(gltf, "cameras").size());
    use_.area_lights.resize(gltf_area_lights(gltf).size());
    use_.skinned_meshes.resize(use_.meshes.size());
    uv_sets_ = uv_sets(gltf_array(gltf, Section::materials));
    for (const std::size_t node : active_nodes(gltf)) add_node(node);
    add_meshes();
    add_materials();
    const Json& scenes = array_or_empty(gltf, "scenes");
    const std::size_t scene = gltf.value("scene", std::size_t{0});
    const Json& relook =
        scene < scenes.size() ? object_in(object_in(scenes[scene], "extras"), "relook") : array_or_empty(gltf, "");
    const Json& environment = object_in(relook, "environment");
    for (const Json* owner : {&environment, &object_in(environment, "background")})
      mark_named(*owner, "image", gltf_array(gltf, Section::images), use_.images);
  }
  GltfUse take() { return std::move(use_); }

 private:
  std::vector<std::pair<Section, std::vector<bool>*>> sections() {
    return {{Section::nodes, &use_.nodes},       {Section::lights, &use_.lights},
            {Section::meshes, &use_.meshes},     {Section::skins, &use_.skins},
            {Section::materials, &use_.materials}, {Section::textures, &use_.textures},
            {Section::images, &use_.images},     {Section::samplers, &use_.samplers}};
  }

  void add_node(std::size_t index) {
    use_.nodes[index] = true;
    const Json& node = gltf_["nodes"][index];
    const std::size_t mesh = mark(node, "mesh", use_.meshes);
    if (mesh != SIZE_MAX && mark(node, "skin", use_.skins) != SIZE_MAX) use_.skinned_meshes[mesh] = true;
    (void)mark(node, "camera", use_.cameras);
    (void)mark(object_in(object_in(node, "extensions"), "KHR_lights_punctual"), "light", use_.lights);
    (void)mark(object_in(object_in(node, "extensions"), "EXT_lights_area"), "light", use_.area_lights);
    const Json& relook = object_in(object_in(node, "extras"), "relook");
    mark_named(object_in(relook, "displacement"), "texture", gltf_array(gltf_, Section::textures), use_.textures);
  }

  void add_meshes() {
    const Json& meshes = gltf_array(gltf_, Section::meshes);
    const Json& materials = gltf_array(gltf_, Section::materials);
    use_.primitives.resize(meshes.size());
    for (std::size_t m = 0; m < meshes.size(); ++m)
      for (const Json& primitive : array_or_empty(meshes[m], "primitives")) {
        auto& [uv, is_lit] = use_.primitives[m].emplace_back();
        const auto add_material = [&](const Json& owner) {
          const std::size_t material = index_in(owner, "material", use_.materials.size());
          if (material == SIZE_MAX) return void(is_lit = true);
          is_lit = is_lit || !object_in(materials[material], "extensions").contains("KHR_materials_unlit");
          if (use_.meshes[m]) use_.materials[material] = true;
          for (std::size_t set = 0; set < uv.size(); ++set) uv[set] = uv[set] || uv_sets_[material][set];
        };
        add_material(primitive);
        const Json& variants = object_in(object_in(primitive, "extensions"), "KHR_materials_variants");
        for (const Json& mapping : array_or_empty(variants, "mappings"))
          if (mapping.is_object()) add_material(mapping);
      }
  }

  void add_materials() {
    const Json& materials = gltf_array(gltf_, Section::materials);
    for (std::size_t m = 0; m < materials.size(); ++m)
      if (use_.materials[m])
        for_each_slot(file_material_schema(), materials[m],
                      [&](const Json& info) { (void)mark(info, "index", use_.textures); });
    const Json& textures = gltf_array(gltf_, Section::textures);
    for (std::size_t t = 0; t < textures.size(); ++t) {
      if (!use_.textures[t]) continue;
      mark_source(textures[t]);
      (void)mark(textures[t], "sampler", use_.samplers);
    }
  }

  /// Of several images one is chosen once their data is known (resolve_texture_sources): each alone may be missing.
  void mark_source(const Json& texture) {
    const Json& extensions = object_in(texture, "extensions");
    const Json* only = nullptr;
    for (const Json* owner : {&object_in(extensions, "EXT_texture_webp"), &texture,
                              &object_in(extensions, "KHR_texture_basisu")}) {
      if (index_in(*owner, "source", use_.images.size()) == SIZE_MAX) continue;
      if (only != nullptr) return;
      only = owner;
    }
    if (only != nullptr) (void)mark(*only, "source", use_.images);
  }

  const Json& gltf_;
  GltfUse use_;
  std::vector<std::array<bool, 2>> uv_sets_;
};

}  // namespace

const std::vector<bool>& GltfUse::of(Section section) const {
  switch (section) {
    case Section::materials:
      return materials;
    case Section::textures:
      return textures;
    case Section::images:
      return images;
    case Section::samplers:
      return samplers;
    case Section::meshes:
      return meshes;
    case Section::lights:
      return lights;
    case Section::skins:
      return skins;
    case Section::nodes:
      break;
  }
  return nodes;
}

bool GltfUse::reads(std::size_t mesh, std::size_t primitive, std::string_view semantic) const {
  const Primitive& read = primitives[mesh][primitive];
  if (!meshes[mesh] || semantic == "TANGENT") return false;
  if (semantic == "NORMAL") return read.is_lit;
  if (semantic.starts_with("JOINTS_") || semantic.starts_with("WEIGHTS_")) return skinned_meshes[mesh];
  if (semantic.starts_with("TEXCOORD_"))
    return (semantic == "TEXCOORD_0" && read.uv[0]) || (semantic == "TEXCOORD_1" && read.uv[1]);
  return semantic == "POSITION" || semantic == "COLOR_0";
}

GltfUse gltf_use(const Json& gltf) { return Reach(gltf).take(); }

const Json& gltf_array(const Json& gltf, Section section) {
  if (section != Section::lights) return array_or_empty(gltf, section_name(section));
  return array_or_empty(object_in(object_in(gltf, "extensions"), "KHR_lights_punctual"), "lights");
}

const Json& gltf_area_lights(const Json& gltf) {
  return array_or_empty(object_in(object_in(gltf, "extensions"), "EXT_lights_area"), "lights");
}

}  // namespace relook
