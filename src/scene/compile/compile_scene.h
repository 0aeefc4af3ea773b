// One compilation of a scene: from the entries of the look document that were touched to the tables that depend on
// them, along the references between entries. All or nothing; its cost follows what was touched and its users. Run by
// SceneState (state.h) when a document is opened and after every edit.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/compile/compile_material.h"
#include "scene/compile/compile_transform.h"
#include "scene/compile/deformation.h"
#include "scene/compile/state.h"

namespace relook {

/// What the compiler knows about a node that exists.
struct NodeRecord {
  std::string parent;  // "" for roots
  WideTransform world;
  bool visible = true;                           // itself and all its ancestors
  bool is_compiled = false;                      // false until its first visit
  std::uint64_t last_start = 0, last_visit = 0;  // SceneIndex::runs when a visit last started here, and came by
  std::vector<ObjectId> objects;                 // of its mesh
  LightId light;
};

struct TouchedEntityHash {
  std::size_t operator()(const TouchedEntity& entity) const {
    return std::hash<std::string>()(entity.section) * 31 + std::hash<std::string>()(entity.name);
  }
};

/// The compiler's memory from one edit to the next: names to slots, and who refers to whom. Slots of entities that were
/// removed stay for their return.
struct SceneIndex {
  std::uint64_t runs = 0;  // compilations so far
  std::unordered_map<std::string, NodeRecord> nodes;
  std::unordered_map<std::string, MaterialId> materials;
  MaterialId default_material;                          // of primitives without a material
  std::unordered_map<std::uint64_t, ObjectId> objects;  // by key
  std::size_t first_objects = 0;                        // slots of the scene as it was opened
  std::unordered_map<std::string, LightId> lights;      // by node
  std::unordered_map<MaterialId, LightId> emission;     // under Integrator::path, as the next two
  LightId suns;
  std::set<std::string> excluding;                      // nodes whose light excludes others
  std::unordered_map<TouchedEntity, std::vector<TouchedEntity>, TouchedEntityHash> references;
  std::unordered_map<TouchedEntity, std::unordered_set<TouchedEntity, TouchedEntityHash>, TouchedEntityHash> users;

  /// The slot of a light is no more.
  void forget(const Light& light);
};

/// The most objects, primitives times instances, that edits may add to a scene. Removed ones keep their slots.
inline constexpr std::size_t kMostAddedObjects = 500'000;

/// An entry of the look document to compile.
struct CompiledEntity {
  TouchedEntity place;
  const Json* value = nullptr;  // null: removed
  bool is_touched = false;      // by the edit; false: only something that it refers to was
};

/// Every entity of the document in the order of their places, for a compilation from scratch.
[[nodiscard]] std::vector<CompiledEntity> all_entities(const LookDocument& document);

class Compilation {
 public:
  Compilation(const LookDocument& document, PyramidStore& pyramids, Scene& scene, SceneIndex& index,
              std::string_view file)
      : document_(document), scene_(scene), index_(index), context_{document, pyramids, file} {}

  /// Compiles what was touched and its users. Throws InputError; scene and index are then as before.
  SceneDelta run(const std::vector<TouchedEntity>& touched);
  /// Compiles entities of a new scene, by increasing place, which check_entity() (look_check.h) has passed and which
  /// have no users as yet. Throws InputError; the scene is then of no use, since nothing is noted of what was there
  /// before.
  void run_first(const std::vector<CompiledEntity>& entities);

 private:
  using Entity = CompiledEntity;
  using Entities = std::vector<Entity>;  // increasing places
  struct NodeVisit {
    std::pair<const std::string, NodeRecord>* node = nullptr;  // of the index
    const Json* value = nullptr;
    std::size_t depth = 0;  // 1: a root
  };

  // compile_scene.cpp
  void check(const Entities& entities) const;
  void compile(const Entities& entities);
  [[nodiscard]] Entities with_users(const std::vector<TouchedEntity>& touched) const;
  [[nodiscard]] const Json* value_of(const TouchedEntity& entity) const;
  void check_variants() const;
  void update_references(const Entity& entity);
  void set_references(const TouchedEntity& entity, std::vector<TouchedEntity> references);
  void update_material(const Entity& entity);
  void update_scene_entry();
  [[nodiscard]] SceneDelta delta();
  void roll_back();
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const;

  // compile_nodes.cpp
  void update_nodes(const Entities& entities);
  void unlink_children(const TouchedEntity& node);
  void link_children(const Entity& node);
  void forget_node(const std::string& node);
  [[nodiscard]] std::vector<NodeVisit> visits(const Entities& entities);
  void find_depths(std::vector<NodeVisit>& visits) const;
  void visit_subtree(const NodeVisit& top);
  bool visit_node(const std::string& name, const Json& node, NodeRecord& record);
  [[nodiscard]] const std::vector<Transform>* instances_of(const Json& node) const;
  void update_objects(const std::string& name, const Json& node, NodeRecord& record);
  void note_skins_of(const std::string& joint);
  void update_skinned();
  [[nodiscard]] Pose pose_of(const Json& node) const;
  void require_range(const WideTransform& world, const std::string& node) const;
  ObjectId object_slot(const std::string& node, std::uint32_t primitive, std::uint32_t instance);
  void set_object(ObjectId id, Object value);
  void check_camera() const;
  NodeRecord& editable_record(const std::string& node);
  void note(const std::string& node, const NodeRecord& record);

  // compile_lights.cpp
  void update_light(const std::string& name, const Json& node, NodeRecord& record);
  [[nodiscard]] LightId new_light(Light none);
  void set_light(LightId id, Light value);
  void end_light(LightId id);
  void set_excluding(const std::string& node, bool excludes);
  void update_excludes();
  [[nodiscard]] std::vector<ObjectId> objects_below(const Json& nodes) const;
  void update_suns();
  void update_emission(const Entities& entities);
  void update_light_order();

  const LookDocument& document_;
  Scene& scene_;
  SceneIndex& index_;
  CompileContext context_;
  bool notes_history_ = true;  // notes what was there before; not in run_first()

  std::vector<std::string> adopted_;  // nodes with another parent than before
  std::set<std::string> skinned_;     // nodes to compile when all joints are where they belong
  // What was there before, for the delta and for rolling back.
  std::map<TouchedEntity, std::vector<TouchedEntity>> old_references_;
  std::unordered_map<std::string, std::optional<NodeRecord>> old_nodes_;
  std::map<MaterialId, Material> old_materials_;
  std::map<ObjectId, Object> old_objects_;
  std::map<LightId, Light> old_lights_;
  std::vector<std::string> new_materials_;
  std::size_t new_lights_ = 0;
  std::optional<std::set<std::string>> old_excluding_;
  std::vector<std::uint64_t> new_objects_;
  std::optional<Color> old_ambient_;
  std::optional<Environment> old_environment_;
  std::vector<LightId> old_order_;
};

}  // namespace relook
