#include "scene/light_sums.h"

#include <algorithm>
#include <set>

#include "base/layer_names.h"

namespace relook {
namespace {

std::array<double, 3> scaled(const Color& color, float intensity) {
  const auto by = static_cast<double>(intensity);
  return {static_cast<double>(color.x) * by, static_cast<double>(color.y) * by, static_cast<double>(color.z) * by};
}

std::string layer_of(const Light& light) {
  if (light.kind == LightKind::suns) return "suns";
  return light.kind == LightKind::emission ? "emission_" + channel_name(light.light)
                                           : "light_" + channel_name(light.node);
}

std::set<std::string> shared_names(const Scene& scene) {
  std::set<std::string> names;
  for (const LightId id : scene.light_order)
    if (!scene.light(id).sum.empty()) names.insert(scene.light(id).sum);
  return names;
}

/// Collects them in their order.
class SumList {
 public:
  explicit SumList(const Scene& scene) : scene_(scene) {}

  std::vector<LightSum> all() {
    const Environment& environment = scene_.environment;
    for (const LightId id : scene_.light_order)
      if (traits_of(scene_.light(id).kind).in_document) add_own(id);
    for (const std::string& name : shared_names(scene_)) {
      add(LightSum::Kind::shared, "lights_" + channel_name(name), {1, 1, 1});
      sums_.back().shared = name;
    }
    for (const LightId id : scene_.light_order) {
      if (traits_of(scene_.light(id).kind).in_document) continue;
      if (scene_.light(id).kind == LightKind::suns)
        add(LightSum::Kind::sky, "sky", scaled(environment.color, environment.intensity));
      add_own(id);
    }
    std::array<double, 3> behind{};
    if (environment.background) behind = scaled(environment.background->color, environment.background->intensity);
    add(LightSum::Kind::ambient, "ambient", scaled(scene_.ambient, 1));
    add(LightSum::Kind::background, "background", behind);
    add(LightSum::Kind::unlit, "unlit", {1, 1, 1});
    return std::move(sums_);
  }

 private:
  void add(LightSum::Kind kind, const std::string& name, std::array<double, 3> color) {
    sums_.push_back({.kind = kind, .light = LightId::none(), .shared = {}, .name = names_.take(name), .color = color});
  }
  void add_own(LightId id) {
    const Light& light = scene_.light(id);
    if (!light.sum.empty()) return;
    add(LightSum::Kind::light, layer_of(light), color_of_light(light));
    sums_.back().light = id;
  }

  const Scene& scene_;
  std::vector<LightSum> sums_;
  LayerNames names_;
};

}  // namespace

std::vector<LightSum> light_sums(const Scene& scene) { return SumList(scene).all(); }

std::size_t lights_in_shared_sums(const Scene& scene) {
  const auto sharing = std::ranges::count_if(scene.light_order, [&](LightId id) { return !scene.light(id).sum.empty(); });
  return static_cast<std::size_t>(sharing) - shared_names(scene).size();
}

std::array<double, 3> color_of_light(const Light& light) { return scaled(light.color, light.intensity); }

}  // namespace relook
