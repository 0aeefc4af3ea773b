// The scene frozen for rays: its objects as intersection, surface points and spawning need them, and where its lights
// and its camera are. Invariant: a RayScene never changes. An edit gives another one, made from the one before it and
// complete before anybody can read it; the two share what the edit did not touch. The order of a step is: edit the
// Scene (edit/), classify by the RayScene from before and the Scene from after, freeze with after(), trace. Colours are
// not worked out from it alone: programs read their parameters in the Scene (color/color_scene.h).
#pragma once
#include <memory>
#include <vector>

#include "trace/light/ray_light.h"
#include "trace/ray_object.h"
#include "trace/shared_table.h"

namespace relook {

/// Cheap to copy: copies are one scene.
class RayScene {
 public:
  explicit RayScene(const Scene& scene);

  /// What follows this state by `delta`; `scene` is the state after it. Only the entries that it names are made anew.
  /// One state after the other: not from several threads at a time.
  [[nodiscard]] RayScene after(const Scene& scene, const SceneDelta& delta) const;

  [[nodiscard]] const RayObject& object(ObjectId id) const { return *objects_[id.index()]; }
  /// The same for who keeps it beyond the scene.
  [[nodiscard]] const std::shared_ptr<const RayObject>& share(ObjectId id) const {
    return tables_->objects.share(id.index());
  }
  [[nodiscard]] std::size_t size() const { return tables_->objects.size(); }

  /// Living lights by node name, as Scene has them, and each at its place in that order.
  [[nodiscard]] const std::vector<LightId>& light_order() const { return tables_->lights->order; }
  [[nodiscard]] const RayLight& light(std::size_t place) const { return tables_->lights->placed[place]; }
  /// The environment's image in its parts; null under Integrator::whitted.
  [[nodiscard]] const std::shared_ptr<const EnvironmentLight>& environment() const {
    return tables_->lights->environment;
  }
  [[nodiscard]] const Camera& camera() const { return *tables_->camera; }

  [[nodiscard]] std::size_t material_count() const { return tables_->users.size(); }
  /// The objects that have a material, increasing; dead ones may have got another one since they died.
  [[nodiscard]] const std::vector<ObjectId>& users_of(MaterialId id) const { return tables_->users[id.index()]; }

  /// The entry of an object whose Object value and material were others.
  [[nodiscard]] RayObject make_object(const Scene& scene, const Object& object, const Material& material) const;

 private:
  struct Lights {
    std::vector<LightId> order;
    std::vector<RayLight> placed;  // in this order
    std::shared_ptr<const EnvironmentLight> environment;
    std::shared_ptr<const TexturePyramid> image;  // of it
  };
  struct Tables {
    SharedTable<RayObject> objects;            // by ObjectId
    SharedTable<Material> materials;           // by MaterialId, shared by their objects
    SharedTable<std::vector<ObjectId>> users;  // by MaterialId
    std::shared_ptr<const Lights> lights;
    std::shared_ptr<const Camera> camera;   // no edit moves it
    std::shared_ptr<RayObjectMaker> maker;  // of all states of a scene
  };

  explicit RayScene(std::shared_ptr<const Tables> tables)
      : tables_(std::move(tables)), objects_(tables_->objects.entries()) {}
  static void apply(Tables& tables, const Scene& scene, const SceneDelta& delta);
  static void apply_to_lights(Tables& tables, const Scene& scene);
  static void apply_to_objects(Tables& tables, const Scene& scene, const SceneDelta& delta);

  std::shared_ptr<const Tables> tables_;
  const RayObject* const* objects_;  // of the tables
};

}  // namespace relook
