// glTF to look document, make_look_document(): arrays become objects keyed by unique name, indices become names, every
// default is filled in, what relook does not support is left out, and so are nodes that the active scene does not
// reach.
#include "scene/look/look.h"

#include "scene/gltf/check/gltf_use.h"
#include "scene/look/counted_assets.h"
#include "scene/look/light_shares.h"
#include "scene/look/look_check.h"
#include "scene/look/look_names.h"
#include "scene/look/look_schema.h"
#include "scene/look/sides.h"

namespace relook {
namespace {

const Json& member_or_empty(const Json& value, std::string_view key) {
  static const Json empty = Json::array();
  if (!value.is_object()) return empty;
  const auto found = value.find(key);
  return found == value.end() ? empty : *found;
}

/// One unique printable name per item of a glTF array.
std::vector<std::string> names_of(const Json& items, std::string_view noun) {
  UniqueNames unique;
  std::vector<std::string> names;
  names.reserve(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Json& given = member_or_empty(items[i], "name");
    std::string name = given.is_string() ? printable(given.get_ref<const std::string&>()) : "";
    if (name.empty()) name = std::string(noun) + "_" + std::to_string(i);
    names.push_back(unique.give(std::move(name)));
  }
  return names;
}

/// Fills document.cameras. Returns the cameras' names in the order of the file. `active`: nodes of the active scene.
std::vector<std::string> name_cameras(const Json& gltf, const std::vector<std::size_t>& active,
                                      LookDocument& document) {
  const Json& cameras = member_or_empty(gltf, "cameras");
  const std::vector<std::string> names = names_of(cameras, "camera");
  document.cameras = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i)
    document.cameras[names[i]] = {{"node", ""}, {"camera", cameras[i]}, {"index", i}};
  for (auto node = active.rbegin(); node != active.rend(); ++node) {
    const Json& camera = member_or_empty(gltf["nodes"][*node], "camera");
    if (camera.is_number_unsigned())
      document.cameras[names.at(camera)]["node"] = document.order[static_cast<std::size_t>(Section::nodes)][*node];
  }
  return names;
}

void name_variants(const Json& gltf, LookDocument& document) {
  const Json& extension = member_or_empty(member_or_empty(gltf, "extensions"), "KHR_materials_variants");
  const Json& variants = member_or_empty(extension, "variants");
  if (!variants.empty())
    document.look["extensions"]["KHR_materials_variants"]["variants"] = names_of(variants, "variant");
}

/// Puts the name of a node's camera where its index is. name_indices() would search all cameras for each node.
void name_camera(const std::vector<std::string>& cameras, Json& node) {
  const Json& index = member_or_empty(node, "camera");
  if (index.is_number_unsigned() && index.get<std::size_t>() < cameras.size())
    node["camera"] = cameras[index.get<std::size_t>()];
}

/// The most morph targets that a primitive of the mesh has.
std::size_t target_count(const LookDocument& document, const std::string& mesh) {
  std::size_t count = 0;
  if (const auto found = document.assets->mesh_primitives.find(mesh); found != document.assets->mesh_primitives.end())
    for (const MeshId id : found->second) count = std::max(count, document.assets->meshes[id.index()].targets.size());
  return count;
}

/// Makes `weights` as many as there are targets, 0 where none is given.
void fit_weights(Json& value, std::size_t targets) {
  if (targets == 0) {
    value.erase("weights");
    return;
  }
  Json& weights = value["weights"];
  if (weights.is_null()) weights = Json::array();
  if (!weights.is_array()) return;
  Json fitted = Json::array();
  for (std::size_t i = 0; i < targets; ++i) fitted.push_back(i < weights.size() ? weights[i] : Json(0.0));
  weights = std::move(fitted);
}

/// Gives a node the weights of its mesh where it has none of its own, so that edits find them at the node (glTF 2.0
/// section 3.7.2.2).
void give_weights(const LookDocument& document, Json& node) {
  const Json& mesh = member_or_empty(node, "mesh");
  const auto found = mesh.is_string() ? document.look["meshes"].find(mesh.get_ref<const std::string&>())
                                      : document.look["meshes"].end();
  if (found == document.look["meshes"].end() || !found->contains("weights")) {
    node.erase("weights");
    return;
  }
  if (!node.contains("weights")) node["weights"] = (*found)["weights"];
  fit_weights(node, (*found)["weights"].size());
}

/// Copies one glTF item into the look document under its name.
void add_entity(LookDocument& document, Section section, std::size_t index, Json value) {
  const std::string& name = document.order[static_cast<std::size_t>(section)][index];
  drop_unknown(schema_of(section), value);
  if (value.is_object()) value.erase("name");
  name_indices(document, section, value);
  if (section == Section::images) set_relook_extra(value, "content", name);
  if (section == Section::meshes) set_relook_extra(value, "geometry", name);
  if (section == Section::nodes && document.instances.contains(name)) set_relook_extra(value, "instances", name);
  if (section == Section::skins) set_relook_extra(value, "inverseBinds", name);
  if (section == Section::meshes) fit_weights(value, target_count(document, name));
  if (section == Section::nodes) give_weights(document, value);
  fill_defaults(section, value);
  document.look[std::string(section_name(section))][name] = std::move(value);
}

void move_assets(ImportedGltf& imported, LookDocument& document) {
  document.assets = counted_assets();
  const auto& mesh_names = document.order[static_cast<std::size_t>(Section::meshes)];
  for (std::size_t i = 0; i < imported.meshes.size(); ++i) {
    std::vector<MeshId>& ids = document.assets->mesh_primitives[mesh_names.at(i)];
    for (Mesh& mesh : imported.meshes[i]) {
      mesh.name = mesh_names[i];
      ids.emplace_back(static_cast<std::uint32_t>(document.assets->meshes.size()));
      document.assets->meshes.push_back(std::move(mesh));
    }
  }
  const auto& image_names = document.order[static_cast<std::size_t>(Section::images)];
  for (std::size_t i = 0; i < imported.images.size(); ++i) {
    imported.images[i].name = image_names.at(i);
    document.assets->images[image_names[i]] = std::move(imported.images[i]);
  }
  const auto& node_names = document.order[static_cast<std::size_t>(Section::nodes)];
  for (std::size_t i = 0; i < imported.instances.size(); ++i)
    if (!imported.instances[i].empty()) document.instances[node_names.at(i)] = std::move(imported.instances[i]);
  const auto& skin_names = document.order[static_cast<std::size_t>(Section::skins)];
  for (std::size_t i = 0; i < imported.inverse_binds.size(); ++i)
    if (!imported.inverse_binds[i].empty())
      document.inverse_binds[skin_names.at(i)] = std::move(imported.inverse_binds[i]);
  count_geometry(document);
}

Json active_scene(const Json& gltf) {
  const Json& scenes = member_or_empty(gltf, "scenes");
  Json scene = scenes.empty() ? Json::object() : scenes.at(gltf.value("scene", std::size_t{0}));
  drop_unknown(scene_schema(), scene);
  return scene;
}

/// What lights of some kinds have and others lack.
void fill_light(Json& light) {
  constexpr double kAreaIntensity = 1000;  // nits: EXT_lights_area
  const Json type = light.value("type", Json());
  if (type == "spot" && !light.contains("spot")) light["spot"] = Json::object();
  if (type != "rect" && type != "disk") return;
  if (!light.contains("intensity")) light["intensity"] = kAreaIntensity;
  if (!light.contains("size")) light["size"] = 1.0;
  if (type == "rect" && !light.contains("rect")) light["rect"] = Json::object();
}

/// The lights of both extensions, as LookDocument::order has them but for the gap.
Json all_lights(const Json& gltf) {
  Json lights = gltf_array(gltf, Section::lights);
  for (const Json& light : gltf_area_lights(gltf)) lights.push_back(light);
  return lights;
}

/// Names the lights, and adds them. Requires: sections before are there.
void add_lights(const Json& gltf, LookDocument& document) {
  const Json lights = all_lights(gltf);
  const std::size_t punctual = gltf_array(gltf, Section::lights).size();
  auto& order = document.order[static_cast<std::size_t>(Section::lights)];
  order = names_of(lights, target_noun(Target::lights));
  for (std::size_t i = 0; i < lights.size(); ++i) add_entity(document, Section::lights, i, lights[i]);
  if (lights.size() > punctual) order.insert(order.begin() + static_cast<std::ptrdiff_t>(punctual), "");
}

}  // namespace

void fill_defaults(Section section, Json& value) {
  if (!value.is_object()) return;
  if (section == Section::materials && value.contains(Json::json_pointer("/extensions/KHR_materials_unlit")) &&
      !value.contains(Json::json_pointer("/extras/relook/model"))) {
    Json& extras = value["extras"];
    if (extras.is_null()) extras = Json::object();
    if (extras.is_object() && (!extras.contains("relook") || extras["relook"].is_object()))
      extras["relook"]["model"] = "unlit";
  }
  if (section == Section::materials && !value.contains("doubleSided") && is_solid(value)) value["doubleSided"] = true;
  if (section == Section::lights) fill_light(value);
  if (section == Section::nodes && value.contains("matrix")) {
    // A node has either a matrix or translation, rotation and scale: no defaults for the latter beside the former.
    const Json given = value;
    fill_from_schema(schema_of(section), value);
    for (const char* key : {"translation", "rotation", "scale"})
      if (!given.contains(key)) value.erase(key);
    return;
  }
  fill_from_schema(schema_of(section), value);
}

LookDocument make_look_document(ImportedGltf imported) {
  LookDocument document;
  document.file = imported.file;
  const Json& gltf = imported.gltf;
  document.look = Json::object();
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const auto section = static_cast<Section>(s);
    document.look[std::string(section_name(section))] = Json::object();
    if (section != Section::lights)
      document.order[s] = names_of(gltf_array(gltf, section), target_noun(static_cast<Target>(s)));
  }
  move_assets(imported, document);
  const std::vector<std::size_t> active = active_nodes(gltf);
  const std::vector<std::string> cameras = name_cameras(gltf, active, document);
  name_variants(gltf, document);
  for (std::size_t s = 0; s < kSectionCount; ++s) {
    const auto section = static_cast<Section>(s);
    if (section == Section::nodes) continue;
    if (section == Section::lights) {
      add_lights(gltf, document);
      continue;
    }
    const Json& items = gltf_array(gltf, section);
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (section == Section::skins && !document.inverse_binds.contains(document.order[s][i])) continue;
      Json item = items[i];
      if (section == Section::materials) resolve_sides(item);
      add_entity(document, section, i, std::move(item));
    }
  }
  for (std::size_t index : active) {
    Json node = gltf["nodes"][index];
    name_camera(cameras, node);
    add_entity(document, Section::nodes, index, std::move(node));
  }
  document.look["scene"] = active_scene(gltf);
  fill_from_schema(scene_schema(), document.look["scene"]);
  check_values(document);
  write_light_shares(document, document.order[static_cast<std::size_t>(Section::lights)]);
  return document;
}

}  // namespace relook
