#include "scene/look/look_bounds.h"

#include <map>
#include <set>

#include "scene/compile/deformation.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

struct Place {
  WideTransform world;
  bool visible = true;
};

const Json* member(const Json& value, std::string_view pointer) {
  const Json::json_pointer at{std::string(pointer)};
  return value.contains(at) ? &value[at] : nullptr;
}

WideTransform own_transform(const Json& node, const LookDocument& document, const std::string& name, bool is_unscaled) {
  const std::string pointer = "/nodes/" + escape_token(name);
  if (!is_unscaled) return local_transform(node, document.file, pointer);
  Json without = node;
  without.erase("scale");
  return local_transform(without, document.file, pointer);
}

/// Every node's place in the world. `unscaled`: a node whose own scale is left out.
std::map<std::string, Place> places_of(const LookDocument& document, std::string_view unscaled = {}) {
  const Json& nodes = document.look.at("nodes");
  std::set<std::string> children;
  for (const Json& node : nodes)
    for (const Json& child : node.at("children")) children.insert(child.get<std::string>());
  std::map<std::string, Place> places;
  std::vector<std::string> todo;
  for (const auto& item : nodes.items())
    if (!children.contains(item.key())) {
      places[item.key()] = {};
      todo.push_back(item.key());
    }
  while (!todo.empty()) {
    const std::string name = std::move(todo.back());
    todo.pop_back();
    Place& place = places[name];  // holds the parent's place until here
    const Json& node = nodes.at(name);
    place.world = own_transform(node, document, name, unscaled == name) * place.world;
    const Json* visible = member(node, "/extensions/KHR_node_visibility/visible");
    place.visible = place.visible && (visible == nullptr || *visible == true);
    for (const Json& child : node.at("children"))
      if (nodes.contains(child.get<std::string>()) && places.try_emplace(child.get<std::string>(), place).second)
        todo.push_back(child.get<std::string>());
  }
  return places;
}

/// The pose of a node whose skin is whole; none for others, which the compiler refuses.
Pose pose_of(const LookDocument& document, const std::map<std::string, Place>& places, const Json& node) {
  const Json* name = member(node, "/skin");
  if (name == nullptr) return {};
  const Json& skin = document.look.at("skins").at(name->get<std::string>());
  const auto inverse_binds = document.inverse_binds.find(skin["extras"]["relook"].value("inverseBinds", ""));
  const bool is_whole = inverse_binds != document.inverse_binds.end() && skin.contains("joints") &&
                        skin["joints"].size() == inverse_binds->second.size();
  if (!is_whole) return {};
  return posed(skin, inverse_binds->second, [&](const std::string& joint) { return places.at(joint).world; });
}

/// A primitive as a node shows it, once for each of `matrices` unless a skin places it.
void place_mesh(const std::string& node, const Mesh& mesh, const Json* weights, const Pose& pose,
                const std::vector<Transform>& matrices, const WideTransform& world, const PlacedMeshVisit& visit) {
  const SharedDeformation deformation = deformation_of(mesh, weights, pose);
  const bool is_skinned = deformation && !(*deformation).joints.empty();
  if (is_skinned && mesh.joint_count() > pose.joints.size()) return;
  const Mesh shaped = deformation ? deformed(mesh, *deformation) : Mesh();
  const Mesh& shown = deformation ? shaped : mesh;
  if (is_skinned) return visit(node, shown, WideTransform().setTranslation(pose.place));
  for (const Transform& matrix : matrices) visit(node, shown, widened(matrix) * world);
}

}  // namespace

WideTransform unscaled_transform(const LookDocument& document, const std::string& node) {
  return places_of(document, node).at(node).world;
}

void for_each_placed_mesh(const LookDocument& document, const PlacedMeshVisit& visit) {
  const std::map<std::string, Place> places = places_of(document);
  for (const auto& [name, place] : places) {
    const Json& node = document.look.at("nodes").at(name);
    if (!place.visible || !node.contains("mesh")) continue;
    const Json& mesh = document.look.at("meshes").at(node["mesh"].get<std::string>());
    const Json* geometry = member(mesh, "/extras/relook/geometry");
    if (geometry == nullptr || !document.assets->mesh_primitives.contains(geometry->get<std::string>())) continue;
    const Pose pose = pose_of(document, places, node);
    const Json* instances = member(node, "/extras/relook/instances");
    const std::vector<Transform> alone(1);
    const std::vector<Transform>& matrices =
        instances == nullptr ? alone : document.instances.at(instances->get<std::string>());
    for (MeshId id : document.assets->mesh_primitives.find(geometry->get<std::string>())->second)
      place_mesh(name, document.assets->meshes[id.index()], weights_of(node, mesh), pose, matrices, place.world, visit);
  }
}

void for_each_place(const LookDocument& document,
                    const std::function<void(const std::string&, const Json&, const WideTransform&)>& visit) {
  for (const auto& [name, place] : places_of(document))
    if (place.visible) visit(name, document.look.at("nodes").at(name), place.world);
}

WideBox world_bounds(const LookDocument& document) {
  WideBox bounds;
  for_each_placed_mesh(document, [&](const std::string&, const Mesh& mesh, const WideTransform& world) {
    if (mesh.bounds.isEmpty()) return;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Imath::V3d local(static_cast<double>((corner & 1U) != 0 ? mesh.bounds.max.x : mesh.bounds.min.x),
                             static_cast<double>((corner & 2U) != 0 ? mesh.bounds.max.y : mesh.bounds.min.y),
                             static_cast<double>((corner & 4U) != 0 ? mesh.bounds.max.z : mesh.bounds.min.z));
      bounds.extendBy(local * world);
    }
  });
  return bounds;
}

}  // namespace relook
