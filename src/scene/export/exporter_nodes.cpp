// What stands where: skins, nodes, scenes, animations.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/compile/compile_material.h"
#include "scene/compile/compile_transform.h"
#include "scene/export/export_values.h"
#include "scene/export/exporter.h"
#include "scene/gltf/check/gltf_use.h"
#include "scene/gltf/gltf_json.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

constexpr std::array<const char*, 2> kLightExtensions{"KHR_lights_punctual", "EXT_lights_area"};

/// Removes an extension, and the list of them with the last one.
void erase_extension(Json& owner, const char* name) {
  if (!owner.contains("extensions")) return;
  owner["extensions"].erase(name);
  if (owner["extensions"].empty()) owner.erase("extensions");
}

const std::string* key_in(const Json& node, const char* key) {
  const Json* found = member_at(node, {"extras", "relook", key});
  return found == nullptr ? nullptr : &found->get_ref<const std::string&>();
}

}  // namespace

bool Exporter::is_above(const std::string& node, const std::string& other) const {
  for (std::string at = other;;) {
    if (at == node) return true;
    const auto parent = parents_.find(at);
    if (parent == parents_.end()) return false;
    at = parent->second;
  }
}

/// None for one that only idle nodes have, of which joints are gone.
std::optional<Json> Exporter::skin(const Slot& slot) {
  static const Json none = Json::array();
  const Json& source = source_ == nullptr ? none : array_or_empty(source_->gltf, "skins");
  if (slot.name.empty()) {
    Json idle = source[slot.source];
    for (Json& joint : idle["joints"]) {
      const std::size_t at = moved(Section::nodes, joint);
      if (at == kNowhere) return std::nullopt;
      joint = at;
    }
    const std::size_t skeleton = moved(Section::nodes, idle.value("skeleton", Json()));
    idle.erase("skeleton");
    if (skeleton != kNowhere) idle["skeleton"] = skeleton;
    return idle;
  }
  const std::string& key = *key_in(look(Section::skins)[slot.name], "inverseBinds");
  const auto at = source_of_key(Section::skins, key);
  Json skin = written(Section::skins, slot.name, at ? &source[*at] : nullptr, before(Section::skins, key));
  const Json joints = skin["joints"];
  const std::size_t skeleton = moved(Section::nodes, skin.value("skeleton", Json()));
  skin.erase("skeleton");
  if (skeleton != kNowhere) {
    const std::string& name = entries(Section::nodes).slots[skeleton].name;
    if (std::ranges::all_of(joints, [&](const Json& joint) { return is_above(name, joint.get<std::string>()); }))
      skin["skeleton"] = skeleton;
  }
  name_to_index(Section::skins, skin);
  if (!at) skin["inverseBindMatrices"] = columns_.add_matrices(document_.inverse_binds.at(key));
  return skin;
}

void Exporter::write_skins() {
  Entries& skins = entries_[static_cast<std::size_t>(Section::skins)];
  Entries kept;
  kept.moved.assign(skins.moved.size(), kNowhere);
  Json list = Json::array();
  for (const Slot& slot : skins.slots) {
    std::optional<Json> value = skin(slot);
    if (!value) continue;
    if (slot.source != kNowhere) kept.moved[slot.source] = list.size();
    if (!slot.name.empty()) kept.index.emplace(slot.name, list.size());
    list.push_back(std::move(*value));
  }
  skins = std::move(kept);
  gltf_["skins"] = std::move(list);
}

void Exporter::write_nodes() {
  Json list = Json::array();
  for (const Slot& slot : entries(Section::nodes).slots)
    list.push_back(slot.name.empty() ? idle_node(slot) : node(slot));
  // Names of nodes that the scene does not use make room for those of others.
  for (const Slot& slot : entries(Section::nodes).slots) {
    if (!slot.name.empty()) continue;
    const std::string& name = source_->before.order[static_cast<std::size_t>(Section::nodes)][slot.source];
    const auto at = static_cast<std::size_t>(&slot - entries(Section::nodes).slots.data());
    list[at]["name"] =
        unique_name(name, [&](const std::string& candidate) { return look(Section::nodes).contains(candidate); });
  }
  gltf_["nodes"] = std::move(list);
}

Json Exporter::node(const Slot& slot) {
  const Json* source = slot.source == kNowhere ? nullptr : &source_->gltf["nodes"][slot.source];
  const Json& now = look(Section::nodes)[slot.name];
  Json node = written(Section::nodes, slot.name, source, before(Section::nodes, slot.name));
  set_references(slot.name, now, node);
  set_light(now, node);
  set_instances(slot, now, node);
  set_weights(now, node);
  set_rotation(node);
  return node;
}

void Exporter::set_references(const std::string& name, const Json& value, Json& node) {
  for (const auto& [member, section] : {std::pair{"mesh", Section::meshes}, {"skin", Section::skins}}) {
    node.erase(member);
    if (value.contains(member)) node[member] = index_of(section, value[member].get<std::string>());
  }
  node.erase("children");
  for (const Json& child : value.value("children", Json::array()))
    node["children"].push_back(index_of(Section::nodes, child.get<std::string>()));
  set_camera(name, value, node);
}

/// A camera stands at one node: a copy of it does not take it over.
void Exporter::set_camera(const std::string& name, const Json& value, Json& node) {
  node.erase("camera");
  if (!value.contains("camera")) return;
  const auto camera = document_.cameras.find(value["camera"].get_ref<const std::string&>());
  if (camera == document_.cameras.end()) return;
  const bool is_elsewhere = camera->value("node", name) != name && before(Section::nodes, name) == nullptr;
  if (is_elsewhere)
    remark("node \"" + name + "\" leaves camera \"" + camera.key() + "\" to node \"" + camera->value("node", "") +
           "\"");
  else
    node["camera"] = camera->value("index", std::size_t{0});
}

void Exporter::set_light(const Json& value, Json& node) const {
  for (const char* extension : kLightExtensions) erase_extension(node, extension);
  const Json* light = light_name_of(value);
  if (light == nullptr) return;
  const auto& [extension, index] = lights_.at(light->get_ref<const std::string&>());
  node["extensions"][extension]["light"] = index;
}

void Exporter::set_instances(const Slot& slot, const Json& value, Json& node) {
  constexpr const char* kExtension = "EXT_mesh_gpu_instancing";
  const std::string* key = key_in(value, "instances");
  if (key == nullptr) {
    if (value.contains("mesh")) erase_extension(node, kExtension);
    return;
  }
  const auto at = source_of_key(Section::nodes, *key);
  const Json* extension = at ? member_at(source_->gltf["nodes"][*at], {"extensions", kExtension}) : nullptr;
  if (extension != nullptr) {
    node["extensions"][kExtension] = *extension;
    return;
  }
  const auto [known, is_new] = instances_.try_emplace(*key);
  if (is_new) known->second = {{"attributes", columns_.add_instances(document_.instances.find(*key)->second)}};
  node["extensions"][kExtension] = known->second;
  if (slot.source == kNowhere) required_.emplace_back(kExtension);
}

/// Without weights of its own a node takes those of its mesh.
void Exporter::set_weights(const Json& value, Json& node) const {
  node.erase("weights");
  if (!value.contains("weights") || !value.contains("mesh")) return;
  const Json& mesh = look(Section::meshes)[value["mesh"].get_ref<const std::string&>()];
  if (mesh.value("weights", Json()) != value["weights"]) node["weights"] = value["weights"];
}

/// glTF's quaternions have a length of one, which those of edits need not: the same turn, or else the same matrix.
void Exporter::set_rotation(Json& node) const {
  const auto found = node.find("rotation");
  if (found == node.end()) return;
  double squared = 0;
  for (const Json& part : *found) squared += part.get<double>() * part.get<double>();
  constexpr double kTolerance = 5e-3;  // what validators take for rounding
  const double length = std::sqrt(squared);
  if (std::abs(length - 1) <= kTolerance) return;
  const WideTransform wanted = local_transform(node, "", "");
  for (Json& part : *found) part = part.get<double>() / length;
  if (local_transform(node, "", "") == wanted) return;
  for (const char* member : {"translation", "rotation", "scale"}) node.erase(member);
  Json matrix = Json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix.push_back(wanted[row][column]);
  node["matrix"] = std::move(matrix);
}

/// The name of the light that a node of the source places; "" for none.
std::string Exporter::light_of_idle(const Json& node) const {
  const auto& order = source_->before.order[static_cast<std::size_t>(Section::lights)];
  const std::size_t punctual = gltf_array(source_->gltf, Section::lights).size();
  for (std::size_t e = 0; e < kLightExtensions.size(); ++e) {
    const Json* index = member_at(node, {"extensions", kLightExtensions[e], "light"});
    if (index == nullptr) continue;
    const std::size_t at = index->get<std::size_t>() + (e == 0 ? 0 : punctual + 1);
    if (at < order.size()) return order[at];
  }
  return "";
}

/// A node of other scenes, or of none, as it stands in the source, without what is gone.
Json Exporter::idle_node(const Slot& slot) const {
  Json node = source_->gltf["nodes"][slot.source];
  const auto move = [&](const char* member, Section section) {
    if (!node.contains(member)) return;
    const std::size_t index = moved(section, node[member]);
    if (index == kNowhere)
      node.erase(member);
    else
      node[member] = index;
  };
  move("mesh", Section::meshes);
  if (!node.contains("mesh")) {
    node.erase("weights");
    node.erase("skin");
    erase_extension(node, "EXT_mesh_gpu_instancing");
  }
  move("skin", Section::skins);
  Json children = Json::array();
  for (const Json& child : array_or_empty(node, "children")) {
    const std::size_t index = moved(Section::nodes, child);
    if (index != kNowhere && entries(Section::nodes).slots[index].name.empty()) children.push_back(index);
  }
  node.erase("children");
  if (!children.empty()) node["children"] = std::move(children);
  const auto light = lights_.find(light_of_idle(node));
  for (const char* extension : kLightExtensions) erase_extension(node, extension);
  if (light != lights_.end()) node["extensions"][light->second.first]["light"] = light->second.second;
  return node;
}

/// The active scene has the document's roots; others have what is left of theirs.
void Exporter::write_scenes() {
  const std::size_t active = gltf_.value("scene", std::size_t{0});
  if (!gltf_.contains("scenes") || gltf_["scenes"].empty()) gltf_["scenes"] = Json::array({Json::object()});
  for (std::size_t i = 0; i < gltf_["scenes"].size(); ++i) {
    Json& scene = gltf_["scenes"][i];
    Json roots = Json::array();
    const auto& slots = entries(Section::nodes).slots;
    if (i == active) {
      for (std::size_t n = 0; n < slots.size(); ++n)
        if (!slots[n].name.empty() && !parents_.contains(slots[n].name)) roots.push_back(n);
      Json then = source_ == nullptr ? Json::object() : source_->before.look["scene"];
      Json now = document_.look["scene"];
      for (Json* value : {&then, &now}) value->erase("name");
      if (source_ == nullptr) {
        drop_defaults(scene_schema(), now);
        scene.update(now);
      } else {
        write_changes(scene_schema(), then, now, scene);
      }
    } else {
      for (const Json& root : array_or_empty(scene, "nodes")) {
        const std::size_t at = moved(Section::nodes, root);
        if (at != kNowhere && !parents_.contains(slots[at].name)) roots.push_back(at);
      }
    }
    scene.erase("nodes");
    if (!roots.empty()) scene["nodes"] = std::move(roots);
  }
  gltf_["scene"] = active;
}

/// Puts another index into the pointer of KHR_animation_pointer; false for what is gone.
bool Exporter::keeps_pointer(Json& target) const {
  const Json* pointer = member_at(target, {"extensions", "KHR_animation_pointer", "pointer"});
  if (pointer == nullptr || !pointer->is_string() || !pointer->get_ref<const std::string&>().starts_with('/'))
    return true;
  std::vector<std::string> tokens = split_pointer(pointer->get_ref<const std::string&>(), "", "");
  constexpr std::array kMoved{Section::nodes, Section::materials, Section::meshes, Section::textures, Section::skins};
  const auto section = std::ranges::find(kMoved, tokens.front(), section_name);
  if (section == kMoved.end() || tokens.size() < 2) return true;
  const std::size_t at = moved(*section, Json::parse(tokens[1], nullptr, false));
  if (at == kNowhere) return false;
  tokens[1] = std::to_string(at);
  std::string text;
  for (const std::string& token : tokens) text += "/" + escape_token(token);
  target["extensions"]["KHR_animation_pointer"]["pointer"] = text;
  return true;
}

/// False for a target that is gone, or that a file may not animate any more.
bool Exporter::keeps_target(Json& target) const {
  const Json path = target.is_object() ? target.value("path", Json()) : Json();
  if (path == "pointer") return keeps_pointer(target);
  if (!path.is_string() || !target.contains("node")) return true;
  const std::size_t at = moved(Section::nodes, target["node"]);
  if (at == kNowhere) return false;
  target["node"] = at;
  const Json& node = gltf_["nodes"][at];
  if (path != "weights") return !node.contains("matrix");
  const Json& then = source_->gltf["nodes"][entries(Section::nodes).slots[at].source];
  return node.contains("mesh") && moved(Section::meshes, then.value("mesh", Json())) == node["mesh"];
}

void Exporter::write_animations() {
  if (!gltf_.contains("animations")) return;
  Json kept = Json::array();
  std::size_t lost = 0;
  for (Json& animation : gltf_["animations"]) {
    Json channels = Json::array();
    for (Json& channel : animation["channels"]) {
      if (keeps_target(channel["target"]))
        channels.push_back(std::move(channel));
      else
        ++lost;
    }
    animation["channels"] = std::move(channels);
    if (!animation["channels"].empty()) kept.push_back(std::move(animation));
  }
  gltf_["animations"] = std::move(kept);
  if (lost > 0)
    remark(std::to_string(lost) + (lost == 1 ? " channel" : " channels") +
           " of animations moved what is gone or stands otherwise now: left out");
}

}  // namespace relook
