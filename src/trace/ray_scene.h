// The scene frozen for rays: per object what intersection, surface points and spawning need, derived from Scene. A
// change of the scene rebuilds only the entries it names. Colour parameters are read from Scene, not from here.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "scene/compile/tangents.h"
#include "scene/scene.h"
#include "scene/surface_optics.h"

namespace relook {

/// One object, ready for rays.
struct RayObject {
  std::shared_ptr<const Mesh> mesh;                               // deformed and displaced, if the object is
  std::array<std::shared_ptr<const CornerTangents>, 2> tangents;  // by uv set: derived where a map needs them
  std::shared_ptr<const Material> material;  // the values that bend and cut rays, as of this state of the scene
  Transform to_world;
  Imath::M33f normal_to_world;  // inverse transpose of the linear part, not normalised
  float condition = 1;          // of the linear part: how much it stretches rounding errors, at least 1
  float offset = 0;             // metres along the normal that clear a hit of rounding errors
  bool flipped = false;         // negative determinant: counter-clockwise triangles are back faces
  bool alive = false;
  std::uint64_t key = 0;  // orders coincident hits, the same whatever the history of edits
  SurfaceOptics optics;
};

class RayScene {
 public:
  RayScene() = default;
  explicit RayScene(const Scene& scene);

  /// Takes over what `delta` changed; `scene` is the state after it.
  void update(const Scene& scene, const SceneDelta& delta);

  [[nodiscard]] const RayObject& object(ObjectId id) const { return *objects_[id.index()]; }
  [[nodiscard]] std::size_t size() const { return objects_.size(); }
  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] std::size_t material_count() const { return users_.size(); }
  /// The objects that have a material, increasing; dead ones may have got another one since they died.
  [[nodiscard]] const std::vector<ObjectId>& users_of(MaterialId id) const { return users_[id.index()]; }

  /// The entry of an object whose Object value and materials were others: for the selection before an edit.
  [[nodiscard]] RayObject make_object(const Scene& scene, const Object& object, const Material& material) const;

 private:
  void list_user(ObjectId object, MaterialId material);
  [[nodiscard]] std::shared_ptr<const Mesh> mesh_of(const Scene& scene, const Object& object,
                                                    const std::optional<Transform>& sheet) const;
  void set_material(RayObject& object, std::shared_ptr<const Material> material) const;
  [[nodiscard]] std::shared_ptr<const CornerTangents> tangents_of(const std::shared_ptr<const Mesh>& mesh,
                                                                  std::uint8_t texcoord) const;

  const Scene* scene_ = nullptr;
  struct Shaped {
    SharedDeformation deformation;
    std::optional<Displacement> displacement;
    std::optional<Transform> sheet;  // flattened by it
    std::weak_ptr<const Mesh> result;
  };

  struct Derived {
    std::weak_ptr<const Mesh> mesh;  // expired: the address may belong to another mesh by now
    std::weak_ptr<const CornerTangents> result;
  };

  // Made once, while an object uses them.
  mutable std::map<MeshId, std::vector<Shaped>> shaped_;
  mutable std::map<std::pair<const Mesh*, std::uint8_t>, Derived> derived_;  // by mesh and uv set
  std::vector<std::unique_ptr<RayObject>> objects_;         // by ObjectId; none moves or goes: top levels point to them
  std::vector<std::vector<ObjectId>> users_;                // by MaterialId
  std::vector<MaterialId> listed_;                          // by ObjectId: among whose users it is
  std::vector<std::shared_ptr<const Material>> materials_;  // by MaterialId, shared by their objects
};

}  // namespace relook
