#include "replay/path/path_change.h"

#include <algorithm>

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
  }
  rays.lights_changed = order_before != after.light_order() ||
                        std::ranges::find(rays.old_light_index, kNoNode) != rays.old_light_index.end();
}

/// Does what a light gives a hit, beside colour and intensity, follow otherwise from the same samples?
bool shines_otherwise(const Light& before, const Light& after) {
  return before.range != after.range || before.inner_cone != after.inner_cone ||
         before.outer_cone != after.outer_cone || before.visible != after.visible || before.excluded != after.excluded ||
         before.emission != after.emission;
}

bool same_sum(const LightSum& a, const LightSum& b) { return a.kind == b.kind && a.light == b.light; }

void find_afresh(const Scene& scene, const SceneDelta& delta, PathChange& change) {
  const auto sum_of_light = [&](LightId light) {
    return std::ranges::find_if(change.sums, [&](const LightSum& sum) {
             return sum.kind == LightSum::Kind::light && sum.light == light;
           }) - change.sums.begin();
  };
  const auto mark = [&](std::ptrdiff_t sum) {
    if (sum < std::ssize(change.sums)) change.afresh[static_cast<std::size_t>(sum)] = 1;
  };
  for (std::size_t place = 0; place < scene.light_order.size(); ++place)
    if (change.step.rays.old_light_index[place] == kNoNode) mark(sum_of_light(scene.light_order[place]));
  for (const auto& light : delta.lights)
    if (shines_otherwise(light.before, scene.light(light.id))) mark(sum_of_light(light.id));
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

}  // namespace

bool PathChange::any_afresh() const {
  return std::ranges::find(afresh, std::uint8_t{1}) != afresh.end();
}

bool PathChange::touches_samples() const {
  return step.touches_rays() || any_afresh() || !shaded.empty() || !step.colors.reassigned.empty();
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
  for (const auto& [material, fields] : change.step.colors.parameters.materials)
    if ((fields & ~kEmissionMask) != 0) change.shaded.push_back(material);
  if (change.touches_samples()) change.scene_before = before_edit(scene, delta, lights_before);
  return change;
}

}  // namespace relook
