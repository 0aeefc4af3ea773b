// One compilation step of a scene: from the entries of the look document that were touched to the tables that depend on
// them, along the references between entries. All or nothing; its cost follows what was touched and its users.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "scene/compile_material.h"
#include "scene/compile_transform.h"
#include "scene/state.h"

namespace relook {

/// What the compiler knows about a node that exists.
struct NodeRecord {
  std::string parent;  // "" for roots
  WideTransform world;
  bool visible = true;            // itself and all its ancestors
  bool is_compiled = false;       // false until its first visit
  std::vector<ObjectId> objects;  // of its mesh
  LightId light;
};

/// Names to slots, and who refers to whom. Slots of entities that were removed stay for their return.
struct SceneIndex {
  std::unordered_map<std::string, NodeRecord> nodes;
  std::unordered_map<std::string, MaterialId> materials;
  MaterialId default_material;                          // of primitives without a material
  std::unordered_map<std::uint64_t, ObjectId> objects;  // by key
  std::unordered_map<std::string, LightId> lights;      // by node
  std::map<TouchedEntity, std::vector<TouchedEntity>> references;
  std::map<TouchedEntity, std::set<TouchedEntity>> users;
};

/// Every entity of the document, for a compilation from scratch.
[[nodiscard]] std::vector<TouchedEntity> all_entities(const LookDocument& document);

class Compilation {
 public:
  Compilation(const LookDocument& document, PyramidStore& pyramids, Scene& scene, SceneIndex& index,
              std::string_view file)
      : document_(document), scene_(scene), index_(index), context_{document, pyramids, file} {}

  /// Throws InputError with scene and index as before.
  SceneDelta run(const std::vector<TouchedEntity>& touched);

 private:
  using Entities = std::set<TouchedEntity>;

  // compile_scene.cpp
  void check_root() const;
  void check_name(const TouchedEntity& entity) const;
  [[nodiscard]] Entities with_users(const std::vector<TouchedEntity>& touched) const;
  [[nodiscard]] const Json* value_of(const TouchedEntity& entity) const;
  void check_entity(const TouchedEntity& entity) const;
  void check_variants() const;
  void update_references(const TouchedEntity& entity);
  void set_references(const TouchedEntity& entity, std::vector<TouchedEntity> references);
  void update_material(const std::string& name);
  void update_scene_entry();
  [[nodiscard]] SceneDelta delta();
  void roll_back();
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const;

  // compile_nodes.cpp
  void update_nodes(const Entities& entities, const std::vector<TouchedEntity>& touched);
  void unlink_children(const std::string& node);
  void link_children(const std::string& node);
  void forget_node(const std::string& node);
  [[nodiscard]] std::vector<std::string> by_depth();
  void visit_subtree(const std::string& top);
  bool visit_node(const std::string& name, const Json& node);
  [[nodiscard]] const std::vector<Transform>* instances_of(const std::string& name, const Json& node) const;
  void update_objects(const std::string& name, const Json& node, NodeRecord& record);
  void update_light(const std::string& name, const Json& node, NodeRecord& record);
  ObjectId object_slot(const std::string& node, std::uint32_t primitive, std::uint32_t instance);
  void set_object(ObjectId id, Object value);
  void set_light(LightId id, Light value);
  void update_light_order();
  void check_camera() const;
  NodeRecord& editable_record(const std::string& node);

  const LookDocument& document_;
  Scene& scene_;
  SceneIndex& index_;
  CompileContext context_;

  std::set<std::string> starts_;  // nodes to visit, with the subtrees that move with them
  std::set<std::string> visited_;
  // What was there before, for the delta and for rolling back.
  std::map<TouchedEntity, std::vector<TouchedEntity>> old_references_;
  std::unordered_map<std::string, std::optional<NodeRecord>> old_nodes_;
  std::map<MaterialId, Material> old_materials_;
  std::map<ObjectId, Object> old_objects_;
  std::map<LightId, Light> old_lights_;
  std::vector<std::string> new_materials_, new_lights_;
  std::vector<std::uint64_t> new_objects_;
  std::optional<Color> old_ambient_;
  std::optional<Environment> old_environment_;
  std::vector<LightId> old_order_;
};

}  // namespace relook
