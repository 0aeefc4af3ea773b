#include "trace/ray_scene.h"

#include <algorithm>
#include <map>

#include "scene/material_fields.h"
#include "trace/light/emission_source.h"

namespace relook {
namespace {

/// The users of materials as they are to be; those of few materials change.
class UserLists {
 public:
  explicit UserLists(const SharedTable<std::vector<ObjectId>>& before) : before_(before) {}

  void add(MaterialId material, ObjectId object) {
    std::vector<ObjectId>& users = list(material);
    users.insert(std::ranges::lower_bound(users, object), object);
  }
  void remove(MaterialId material, ObjectId object) {
    std::vector<ObjectId>& users = list(material);
    users.erase(std::ranges::lower_bound(users, object));
  }
  /// `materials`: how many there are now.
  void write(SharedTable<std::vector<ObjectId>>& table, std::size_t materials) && {
    while (table.size() < materials) table.push_back(std::make_shared<std::vector<ObjectId>>());
    for (auto& [material, users] : changed_) table.replace(material, std::move(users));
  }

 private:
  std::vector<ObjectId>& list(MaterialId material) {
    const std::size_t i = material.index();
    std::shared_ptr<std::vector<ObjectId>>& users = changed_[i];
    if (!users)
      users = i < before_.size() ? std::make_shared<std::vector<ObjectId>>(before_[i])
                                 : std::make_shared<std::vector<ObjectId>>();
    return *users;
  }

  const SharedTable<std::vector<ObjectId>>& before_;
  std::map<std::size_t, std::shared_ptr<std::vector<ObjectId>>> changed_;  // by MaterialId
};

/// The objects that are sampled for the light of an emitting material, in the order of their keys. None where less than
/// all of it gets out, through holes, coverage or a coat: rays that meet them then bring it alone.
std::vector<EmissionSource::Placed> emitting_objects(const SharedTable<RayObject>& objects, const Material& material,
                                                     const std::vector<ObjectId>& users) {
  std::vector<EmissionSource::Placed> placed;
  if (material.alpha_mode != AlphaMode::opaque || material.clearcoat > 0) return placed;
  for (const ObjectId id : users)
    if (objects[id.index()].alive) placed.push_back({id, objects.share(id.index())});
  std::ranges::sort(placed, {}, [](const EmissionSource::Placed& one) { return one.object->key; });
  return placed;
}

/// Do rays leave hits, or pass holes, by values that differ? If not, and optics and tangents stay, entries keep the
/// material that they have: rays read nothing else of it.
bool turns_rays_otherwise(const Material& before, const Material& after) {
  return differs(MaterialRow::cuts, before, after) || differs(MaterialRow::bends, before, after) ||
         differs(MaterialRow::bends_coat, before, after);
}

}  // namespace

RayScene::RayScene(const Scene& scene) : RayScene([&] {
  auto tables = std::make_shared<Tables>();
  tables->camera = std::make_shared<const Camera>(scene.camera);
  tables->lights = std::make_shared<const Lights>();
  tables->maker = std::make_shared<RayObjectMaker>(scene.integrator);
  apply(*tables, scene, {});
  return std::shared_ptr<const Tables>(std::move(tables));
}()) {}

RayScene RayScene::after(const Scene& scene, const SceneDelta& delta) const {
  auto tables = std::make_shared<Tables>(*tables_);
  apply(*tables, scene, delta);
  return RayScene(std::shared_ptr<const Tables>(std::move(tables)));
}

void RayScene::apply(Tables& tables, const Scene& scene, const SceneDelta& delta) {
  tables.maker->drop_unused();
  for (const auto& change : delta.materials)
    if (change.id.index() < tables.materials.size())
      tables.materials.replace(change.id.index(), std::make_shared<const Material>(scene.material(change.id)));
  for (std::size_t i = tables.materials.size(); i < scene.materials.size(); ++i)
    tables.materials.push_back(std::make_shared<const Material>(scene.materials[i]));
  apply_to_objects(tables, scene, delta);
  apply_to_lights(tables, scene);
}

/// What of them is as it was is shared, so that an edit of colours leaves all of it.
void RayScene::apply_to_lights(Tables& tables, const Scene& scene) {
  const Lights& before = *tables.lights;
  Lights now{scene.light_order, {}, before.environment, before.image};
  if (scene.integrator == Integrator::path && (!now.environment || now.image != scene.environment.image)) {
    now.image = scene.environment.image;
    now.environment = std::make_shared<const EnvironmentLight>(now.image);
  }
  bool all_stay = before.order == now.order && before.environment == now.environment;
  for (std::size_t place = 0; place < now.order.size(); ++place) {
    const Light& light = scene.light(now.order[place]);
    RayLight ray_light(light, scene.integrator);
    if (light.kind == LightKind::suns) ray_light.environment = now.environment;
    if (light.kind == LightKind::emission) {
      std::vector<EmissionSource::Placed> objects =
          emitting_objects(tables.objects, scene.material(light.material), tables.users[light.material.index()]);
      const auto known = std::ranges::find(before.order, now.order[place]);
      const EmissionSource* source =
          known != before.order.end() ? before.placed[static_cast<std::size_t>(known - before.order.begin())].emission.get()
                                      : nullptr;
      ray_light.emission =
          source != nullptr && source->is_of(light.emission, objects)
              ? before.placed[static_cast<std::size_t>(known - before.order.begin())].emission
              : std::make_shared<const EmissionSource>(light.emission, std::move(objects));
    }
    all_stay = all_stay && ray_light.same_place(before.placed[place]);
    now.placed.push_back(std::move(ray_light));
  }
  if (!all_stay) tables.lights = std::make_shared<const Lights>(std::move(now));
}

void RayScene::apply_to_objects(Tables& tables, const Scene& scene, const SceneDelta& delta) {
  RayObjectMaker& maker = *tables.maker;
  UserLists users(tables.users);
  const auto remade = [&](const Object& object) {
    return std::make_shared<const RayObject>(
        maker.make(scene, object, tables.materials.share(object.material.index())));
  };
  const std::size_t known = tables.objects.size();
  for (std::size_t i = known; i < scene.objects.size(); ++i) {
    tables.objects.push_back(remade(scene.objects[i]));
    users.add(scene.objects[i].material, ObjectId(static_cast<std::uint32_t>(i)));
  }
  for (const auto& change : delta.objects) {
    if (change.id.index() >= known) continue;
    const MaterialId before = tables.objects[change.id.index()].material_id, now = scene.object(change.id).material;
    tables.objects.replace(change.id.index(), remade(scene.object(change.id)));
    if (before == now) continue;
    users.remove(before, change.id);
    users.add(now, change.id);
  }
  std::move(users).write(tables.users, scene.materials.size());
  for (const auto& change : delta.materials) {
    const std::shared_ptr<const Material>& material = tables.materials.share(change.id.index());
    const bool turns_rays =
        scene.integrator == Integrator::path || turns_rays_otherwise(change.before, *material);
    for (const ObjectId user : tables.users[change.id.index()]) {
      const RayObject& before = tables.objects[user.index()];
      if (before.material == material) continue;  // made anew above
      RayObject now = before;
      maker.set_material(now, material);
      if (!turns_rays && now.optics == before.optics && now.tangents == before.tangents) continue;
      tables.objects.replace(user.index(), std::make_shared<const RayObject>(std::move(now)));
    }
  }
}

RayObject RayScene::make_object(const Scene& scene, const Object& object, const Material& material) const {
  const std::size_t m = object.material.index();
  const bool is_known = m < tables_->materials.size() && tables_->materials[m] == material;
  return tables_->maker->make(scene, object,
                              is_known ? tables_->materials.share(m) : std::make_shared<const Material>(material));
}

}  // namespace relook
