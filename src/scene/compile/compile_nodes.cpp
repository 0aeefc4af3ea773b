// The node part of a compilation: parents and children, world transforms root to leaf, and the objects that nodes
// place. compile_lights.cpp has their lights.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/hash.h"
#include "scene/compile/compile_scene.h"
#include "scene/compile/displacement.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

std::string node_pointer(const std::string& name) { return "/nodes/" + escape_token(name); }

std::uint64_t object_key(const std::string& node, std::uint32_t primitive, std::uint32_t instance) {
  const char zero = '\0';
  const std::string text = node + zero + std::to_string(primitive) + zero + std::to_string(instance);
  return hash64(bytes_of(text));
}

bool is_shown(const Json& node) { return node["extensions"]["KHR_node_visibility"]["visible"].get<bool>(); }

}  // namespace

NodeRecord& Compilation::editable_record(const std::string& node) {
  const auto [record, is_new] = index_.nodes.try_emplace(node);
  if (!is_new)
    note(node, record->second);
  else if (notes_history_)
    old_nodes_.try_emplace(node, std::nullopt);
  return record->second;
}

/// Notes a node as it was. To be called before its first change in this run.
void Compilation::note(const std::string& node, const NodeRecord& record) {
  if (notes_history_) old_nodes_.try_emplace(node, record);
}

void Compilation::update_nodes(const Entities& entities) {
  const auto is_touched_node = [](const Entity& entity) {
    return entity.is_touched && entity.place.section == "nodes";
  };
  for (const Entity& entity : entities)
    if (is_touched_node(entity)) unlink_children(entity.place);
  for (const Entity& entity : entities)
    if (is_touched_node(entity) && entity.value != nullptr) link_children(entity);
  for (const Entity& entity : entities)
    if (is_touched_node(entity) && entity.value == nullptr) forget_node(entity.place.name);
  for (const NodeVisit& visit : visits(entities)) visit_subtree(visit);
  update_skinned();
  update_excludes();
}

void Compilation::unlink_children(const TouchedEntity& node) {
  const auto references = index_.references.find(node);
  if (references == index_.references.end()) return;
  for (const TouchedEntity& child : references->second) {
    const auto record = child.section == "nodes" ? index_.nodes.find(child.name) : index_.nodes.end();
    if (record == index_.nodes.end() || record->second.parent != node.name) continue;  // a light's node excludes it
    editable_record(child.name).parent.clear();
    adopted_.push_back(child.name);
  }
}

void Compilation::link_children(const Entity& node) {
  const std::string& name = node.place.name;
  (void)editable_record(name);
  const auto children = node.value->find("children");
  if (children == node.value->end()) return;
  for (std::size_t i = 0; i < children->size(); ++i) {
    const auto& child = (*children)[i].get_ref<const std::string&>();
    NodeRecord& record = editable_record(child);
    if (!record.parent.empty())
      fail(node_pointer(name) + "/children/" + std::to_string(i),
           "node \"" + child + "\" is already a child of \"" + record.parent + "\"");
    record.parent = name;
    adopted_.push_back(child);
  }
}

void Compilation::forget_node(const std::string& node) {
  const auto found = index_.nodes.find(node);
  if (found == index_.nodes.end()) return;
  NodeRecord& record = editable_record(node);
  for (ObjectId id : record.objects) {
    Object gone = scene_.object(id);
    gone.alive = false;
    set_object(id, std::move(gone));
  }
  if (!record.light.is_none()) end_light(record.light);
  index_.nodes.erase(found);
}

/// The nodes to start from, by depth: those that were touched or have another parent. Fails on a node that is its own
/// ancestor.
std::vector<Compilation::NodeVisit> Compilation::visits(const Entities& entities) {
  std::vector<NodeVisit> visits;
  // `value`: null if it is still to be found.
  const auto add = [&](const std::string& name, const Json* value) {
    const auto node = index_.nodes.find(name);
    if (node == index_.nodes.end() || std::exchange(node->second.last_start, index_.runs) == index_.runs) return;
    if (value == nullptr) value = value_of({"nodes", name});
    if (value != nullptr) visits.push_back({&*node, value});
  };
  for (const Entity& entity : entities)
    if (entity.place.section == "nodes" && entity.value != nullptr) add(entity.place.name, entity.value);
  const auto adopted = static_cast<std::ptrdiff_t>(visits.size());
  for (const std::string& name : adopted_) add(name, nullptr);
  const auto name_of = [](const NodeVisit& visit) -> const std::string& { return visit.node->first; };
  std::ranges::sort(visits.begin() + adopted, visits.end(), {}, name_of);
  std::ranges::inplace_merge(visits, visits.begin() + adopted, {}, name_of);
  find_depths(visits);
  std::ranges::stable_sort(visits, {}, &NodeVisit::depth);
  return visits;
}

void Compilation::find_depths(std::vector<NodeVisit>& visits) const {
  std::unordered_map<const NodeRecord*, std::size_t> depths;  // 0: on the way up
  std::vector<const NodeRecord*> path;
  for (NodeVisit& visit : visits) {
    path.clear();
    std::size_t depth = 0;
    if (visit.node->second.parent.empty()) {
      visit.depth = 1;
      continue;
    }
    for (const auto* at = visit.node; at != nullptr;) {
      const auto [known, is_new] = depths.try_emplace(&at->second, 0);
      if (!is_new && known->second == 0) fail(node_pointer(at->first) + "/children", "the node is its own ancestor");
      if (!is_new) {
        depth = known->second;
        break;
      }
      path.push_back(&at->second);
      at = at->second.parent.empty() ? nullptr : &*index_.nodes.find(at->second.parent);
    }
    for (auto at = path.rbegin(); at != path.rend(); ++at) depths[*at] = ++depth;
    visit.depth = depth;
  }
}

void Compilation::visit_subtree(const NodeVisit& top) {
  const Json& nodes = document_.look["nodes"];
  std::vector<NodeVisit> todo{top};
  while (!todo.empty()) {
    const NodeVisit visit = todo.back();
    todo.pop_back();
    auto& [name, record] = *visit.node;
    if (record.last_visit == index_.runs) continue;
    if (!visit_node(name, *visit.value, record)) continue;
    const auto children = visit.value->find("children");
    if (children == visit.value->end()) continue;
    for (const Json& child : *children) {
      const auto& child_name = child.get_ref<const std::string&>();
      todo.push_back({&*index_.nodes.find(child_name), &nodes[child_name]});
    }
  }
}

/// Compiles one node. True if its children must follow: it moved, appeared or disappeared.
bool Compilation::visit_node(const std::string& name, const Json& node, NodeRecord& record) {
  note(name, record);
  WideTransform world = local_transform(node, context_.file, node_pointer(name));
  bool visible = is_shown(node);
  if (!record.parent.empty()) {
    const NodeRecord& parent = index_.nodes.at(record.parent);
    world = world * parent.world;
    visible = visible && parent.visible;
  }
  const bool is_changed = !record.is_compiled || record.visible != visible || record.world != world;
  record.world = world;
  record.visible = visible;
  record.is_compiled = true;
  record.last_visit = index_.runs;
  if (node.contains("skin"))
    skinned_.insert(name);
  else
    update_objects(name, node, record);
  update_light(name, node, record);
  if (is_changed) note_skins_of(name);
  return is_changed;
}

/// Notes the nodes whose skin has this joint: they are compiled again once all joints are where they belong.
void Compilation::note_skins_of(const std::string& joint) {
  if (!notes_history_ || document_.look["skins"].empty()) return;  // at first all nodes are visited
  const auto users = index_.users.find({"nodes", joint});
  if (users == index_.users.end()) return;
  for (const TouchedEntity& skin : users->second) {
    const auto nodes = skin.section == "skins" ? index_.users.find(skin) : index_.users.end();
    if (nodes == index_.users.end()) continue;
    for (const TouchedEntity& node : nodes->second) skinned_.insert(node.name);
  }
}

void Compilation::update_skinned() {
  for (const std::string& name : skinned_) {
    const auto node = index_.nodes.find(name);
    const Json* value = node == index_.nodes.end() ? nullptr : value_of({"nodes", name});
    if (value == nullptr) continue;  // removed
    note(name, node->second);
    update_objects(name, *value, node->second);
  }
}

Pose Compilation::pose_of(const Json& node) const {
  const auto name = node.find("skin");
  if (name == node.end()) return {};
  const Json& skin = document_.look["skins"][name->get_ref<const std::string&>()];
  const auto& key = skin["extras"]["relook"]["inverseBinds"].get_ref<const std::string&>();
  return posed(skin, document_.inverse_binds.find(key)->second,
               [&](const std::string& joint) {
                 require_range(index_.nodes.at(joint).world, joint);
                 return index_.nodes.at(joint).world;
               });
}

/// Fails if something that a node carries is out of range; a node that carries nothing may be anywhere.
void Compilation::require_range(const WideTransform& world, const std::string& node) const {
  if (!is_in_range(world)) fail(node_pointer(node), "the node's place in the world is out of range (1e12)");
}

/// The local matrices of a node with EXT_mesh_gpu_instancing, or null.
const std::vector<Transform>* Compilation::instances_of(const Json& node) const {
  const Json* key = member_at(node, {"extras", "relook", "instances"});
  if (key == nullptr) return nullptr;
  return &document_.instances.find(key->get_ref<const std::string&>())->second;
}

void Compilation::update_objects(const std::string& name, const Json& node, NodeRecord& record) {
  const std::vector<ObjectId> before = std::move(record.objects);
  record.objects.clear();
  if (node.contains("mesh")) {
    const Json& mesh = document_.look["meshes"][node["mesh"].get_ref<const std::string&>()];
    const auto& geometry = mesh["extras"]["relook"]["geometry"].get_ref<const std::string&>();
    Object object;
    object.node = name;
    if (const Json* displacement = member_at(node, {"extras", "relook", "displacement"}))
      object.displacement =
          compile_displacement(context_, *displacement, node_pointer(name) + "/extras/relook/displacement");
    const Json* weights = weights_of(node, mesh);
    const Pose pose = pose_of(node);
    for (MeshId mesh_id : document_.assets->mesh_primitives.find(geometry)->second) {
      object.mesh = mesh_id;
      const Mesh& shape = document_.assets->meshes[mesh_id.index()];
      object.deformation = deformation_of(shape, weights, pose);
      const bool is_skinned = object.deformation && !(*object.deformation).joints.empty();
      if (is_skinned && shape.joint_count() > pose.joints.size())
        fail(node_pointer(name) + "/skin", "the mesh names joint " + std::to_string(shape.joint_count() - 1) +
                                               ", the skin has " + std::to_string(pose.joints.size()) + " joints");
      const std::vector<Transform>* instances = is_skinned ? nullptr : instances_of(node);
      const std::size_t instance_count = instances == nullptr ? 1 : instances->size();
      if (object.displacement && displaced_triangles(shape, *object.displacement) > kMostDisplacedTriangles)
        fail(node_pointer(name) + "/extras/relook/displacement/subdivide", "this makes too many triangles");
      object.primitive = shape.primitive;
      const Json& primitive = mesh["primitives"][object.primitive];
      object.material = primitive.contains("material") ? index_.materials.at(primitive["material"].get<std::string>())
                                                       : index_.default_material;
      for (object.instance = 0; object.instance < instance_count; ++object.instance) {
        const WideTransform world = is_skinned             ? WideTransform().setTranslation(pose.place)
                                    : instances == nullptr ? record.world
                                                           : widened((*instances)[object.instance]) * record.world;
        require_range(world, name);
        object.to_world = rounded(world, scene_.camera.eye);
        object.alive = record.visible && dimensions_of(object.to_world) >= 2;
        const ObjectId id = object_slot(name, object.primitive, object.instance);
        object.key = scene_.object(id).key;
        set_object(id, object);
        record.objects.push_back(id);
      }
    }
  }
  if (before.empty()) return;
  std::vector<ObjectId> now = record.objects;
  std::ranges::sort(now);
  for (ObjectId id : before)
    if (!std::ranges::binary_search(now, id)) {
      Object gone = scene_.object(id);
      gone.alive = false;
      set_object(id, std::move(gone));
    }
}

ObjectId Compilation::object_slot(const std::string& node, std::uint32_t primitive, std::uint32_t instance) {
  const std::uint64_t key = object_key(node, primitive, instance);
  const auto [slot, is_new] =
      index_.objects.try_emplace(key, ObjectId(static_cast<std::uint32_t>(scene_.objects.size())));
  if (is_new) {
    if (notes_history_ && scene_.objects.size() >= index_.first_objects + kMostAddedObjects) {
      index_.objects.erase(slot);
      fail(node_pointer(node) + "/mesh", "with this, edits have added more than " + std::to_string(kMostAddedObjects) +
                                             " objects to the scene, the most that they may");
    }
    Object object;
    object.node = node;
    object.primitive = primitive;
    object.instance = instance;
    object.key = key;
    object.alive = false;
    scene_.objects.push_back(std::move(object));
    new_objects_.push_back(key);
  }
  const Object& object = scene_.object(slot->second);
  if (object.node != node || object.primitive != primitive || object.instance != instance)
    fail(node_pointer(node), "the name has the same hash as \"" + object.node + "\": rename one of them");
  return slot->second;
}

void Compilation::set_object(ObjectId id, Object value) {
  Object& now = scene_.objects[id.index()];
  if (now == value) return;
  if (notes_history_) old_objects_.try_emplace(id, now);
  now = std::move(value);
}

void Compilation::check_camera() const {
  const std::string& node = scene_.camera.node;
  const auto old = old_nodes_.find(node);
  if (node.empty() || old == old_nodes_.end() || !old->second) return;
  const auto now = index_.nodes.find(node);
  if (now == index_.nodes.end()) fail(node_pointer(node), "the active camera's node cannot be removed");
  if (now->second.world != old->second->world || now->second.visible != old->second->visible)
    fail(node_pointer(node), "this moves or hides the active camera, which is fixed");
}

}  // namespace relook
