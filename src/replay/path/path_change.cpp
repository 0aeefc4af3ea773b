#include "replay/path/path_change.h"

#include <algorithm>
#include <cmath>

#include "color/path/sum_places.h"
#include "frame/light_sums.h"

namespace relook {
namespace {

/// Fields that are the colour of a light.
constexpr FieldMask kEmissionMask = mask_of(Field::emissive) | mask_of(Field::emissive_strength) | mask_of(Slot::emissive);

/// The scene before an edit, from that after it. Entities that are new stay in it, and nothing names them.
std::shared_ptr<const Scene> before_edit(const Scene& scene, const SceneDelta& delta,
                                         const std::vector<LightId>& light_order) {
  auto before = std::make_shared<Scene>(scene);
  for (const auto& change : delta.materials) before->materials[change.id.index()] = change.before;
  for (const auto& change : delta.objects) before->objects[change.id.index()] = change.before;
  for (const auto& change : delta.lights) before->lights[change.id.index()] = change.before;
  if (delta.ambient_before) before->ambient = *delta.ambient_before;
  if (delta.environment_before) before->environment = *delta.environment_before;
  before->light_order = light_order;
  return before;
}

/// Around all points of a light; empty where it has no place.
Box box_of(const RayLight& light) {
  if (!traits_of(light.kind).has_place || light.emission) return {};
  const auto reach = [&](int axis) {
    return light.radius + std::fabs(light.right[axis]) + std::fabs(light.up[axis]);  // more than its half extents
  };
  const Direction around(reach(0), reach(1), reach(2));
  return {light.position - around, light.position + around};
}

/// Lights that stay where they were keep their places in trees; the others are new.
void match_lights(const RayScene& before, const std::vector<LightId>& order_before, const RayScene& after,
                  RayChange& rays) {
  rays.old_lights = order_before;
  rays.old_light_index.clear();
  for (std::size_t place = 0; place < after.light_order().size(); ++place) {
    const auto old = std::ranges::find(order_before, after.light_order()[place]) - order_before.begin();
    const bool stays = old < std::ssize(order_before) &&
                       before.light(static_cast<std::size_t>(old)).same_place(after.light(place));
    rays.old_light_index.push_back(stays ? static_cast<std::uint32_t>(old) : kNoNode);
    rays.light_boxes.push_back(box_of(after.light(place)));
  }
  rays.find_lost_lights();
  rays.keeps_places = order_before == after.light_order();
  rays.lights_changed = !rays.keeps_places ||
                        std::ranges::find(rays.old_light_index, kNoNode) != rays.old_light_index.end();
}

/// Does what a light gives a hit, beside colour and intensity, follow otherwise from the same samples?
bool shines_otherwise(const Light& before, const Light& after) {
  return before.range != after.range || before.inner_cone != after.inner_cone ||
         before.outer_cone != after.outer_cone || before.visible != after.visible || before.excluded != after.excluded ||
         before.emission != after.emission;
}

/// The same if the light stays where it is: are its terms in its sum otherwise?
bool has_other_terms(const Light& before, const Light& after) {
  return before.sum != after.sum || shines_otherwise(before, after) ||
         (!after.sum.empty() && color_of_light(before) != color_of_light(after));
}

bool same_sum(const LightSum& a, const LightSum& b) {
  return a.kind == b.kind && a.light == b.light && a.shared == b.shared;
}

bool any_of(const std::vector<std::uint8_t>& flags) { return std::ranges::find(flags, std::uint8_t{1}) != flags.end(); }

/// By LightId, of lights that have other terms, are new or gone.
std::vector<std::uint8_t> changed_lights(const Scene& scene, const SceneDelta& delta, const PathChange& change) {
  std::vector<std::uint8_t> changed(scene.lights.size(), 0);
  for (const auto& light : delta.lights)
    if (has_other_terms(light.before, scene.light(light.id))) changed[light.id.index()] = 1;
  for (std::size_t place = 0; place < scene.light_order.size(); ++place)
    if (change.step.rays.old_light_index[place] == kNoNode) changed[scene.light_order[place].index()] = 1;
  for (const LightId light : change.step.rays.old_lights)
    if (!scene.light(light).alive) changed[light.index()] = 1;
  return changed;
}

void find_taken(const Scene& scene, const SceneDelta& delta, const std::vector<std::uint8_t>& changed,
                PathChange& change) {
  std::vector<std::uint8_t> shared(scene.lights.size(), 0);  // by LightId: before the edit
  for (std::size_t i = 0; i < shared.size(); ++i) shared[i] = scene.lights[i].sum.empty() ? 0 : 1;
  for (const auto& light : delta.lights) shared[light.id.index()] = light.before.sum.empty() ? 0 : 1;
  for (const LightId light : change.step.rays.old_lights)
    change.taken.push_back(changed[light.index()] & shared[light.index()]);
}

/// Of the environment's sums.
void find_afresh(const Scene& scene, const SceneDelta& delta, PathChange& change) {
  if (!delta.environment_before) return;
  const Environment &before = *delta.environment_before, &after = scene.environment;
  const bool is_turned = before.image != after.image || before.rotation != after.rotation;
  const auto shape_of = [](const std::optional<Background>& behind) {
    return behind ? std::pair(behind->image, behind->rotation) : std::pair(std::shared_ptr<const TexturePyramid>(), 0.0F);
  };
  const bool is_hidden_otherwise = before.background.has_value() != after.background.has_value();
  const bool is_behind_otherwise = is_hidden_otherwise || shape_of(before.background) != shape_of(after.background);
  for (std::size_t sum = 0; sum < change.sums.size(); ++sum) {
    const LightSum& of = change.sums[sum];
    const bool is_suns = of.kind == LightSum::Kind::light && scene.light(of.light).kind == LightKind::suns;
    if ((of.kind == LightSum::Kind::sky || is_suns) && (is_turned || is_hidden_otherwise)) change.afresh[sum] = 1;
    if (of.kind == LightSum::Kind::background && is_behind_otherwise) change.afresh[sum] = 1;
  }
}

void find_given(const Scene& scene, const std::vector<std::uint8_t>& changed, PathChange& change) {
  const SumPlaces places(scene, change.sums);
  for (std::size_t place = 0; place < places.lights(); ++place) {
    const bool is_changed = changed[scene.light_order[place].index()] != 0;
    std::uint8_t& afresh = change.afresh[places.sum_of[place]];
    if (is_changed && places.shares[place] == 0) afresh = 1;
    change.given.push_back(is_changed || afresh != 0 ? 1 : 0);
  }
}

}  // namespace

bool PathChange::any_afresh() const { return any_of(afresh); }
bool PathChange::any_taken() const { return any_of(taken); }
bool PathChange::any_given() const { return any_of(given); }

bool PathChange::touches_samples() const {
  return step.touches_rays() || relights() || !shaded.empty() || !step.colors.reassigned.empty();
}

PathChange find_path_change(const RayScene& rays_before, const std::vector<LightId>& lights_before,
                            const std::vector<LightSum>& sums_before, const Scene& scene, const RayScene& rays,
                            const SceneDelta& delta) {
  PathChange change(rays_before);
  change.step = find_change(rays_before, scene, delta, lights_before);
  change.sums = light_sums(scene);
  match_lights(rays_before, lights_before, rays, change.step.rays);
  for (const LightSum& sum : change.sums) {
    const auto old = std::ranges::find_if(sums_before, [&](const LightSum& one) { return same_sum(one, sum); });
    const bool is_known = old != sums_before.end();
    change.old_of_new.push_back(is_known ? static_cast<std::uint32_t>(old - sums_before.begin()) : kNewSum);
    change.recolored = change.recolored || !is_known || old->color != sum.color;
  }
  change.recolored = change.recolored || sums_before.size() != change.sums.size();
  change.afresh.assign(change.sums.size(), 0);
  find_afresh(scene, delta, change);
  const std::vector<std::uint8_t> changed = changed_lights(scene, delta, change);
  find_taken(scene, delta, changed, change);
  find_given(scene, changed, change);
  for (const auto& [material, fields] : change.step.colors.parameters.materials)
    if ((fields & ~kEmissionMask) != 0) change.shaded.push_back(material);
  if (change.touches_samples()) change.scene_before = before_edit(scene, delta, lights_before);
  return change;
}

}  // namespace relook
