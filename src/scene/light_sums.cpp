#include "scene/light_sums.h"

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

}  // namespace

std::vector<LightSum> light_sums(const Scene& scene) {
  std::vector<LightSum> sums;
  LayerNames names;
  const auto add = [&](LightSum::Kind kind, LightId light, const std::string& name, std::array<double, 3> color) {
    sums.push_back({kind, light, names.take(name), color});
  };
  const Environment& environment = scene.environment;
  for (const LightId id : scene.light_order) {
    const Light& light = scene.light(id);
    if (light.kind == LightKind::suns)
      add(LightSum::Kind::sky, LightId::none(), "sky", scaled(environment.color, environment.intensity));
    add(LightSum::Kind::light, id, layer_of(light), scaled(light.color, light.intensity));
  }
  std::array<double, 3> behind{};
  if (environment.background) behind = scaled(environment.background->color, environment.background->intensity);
  add(LightSum::Kind::ambient, LightId::none(), "ambient", scaled(scene.ambient, 1));
  add(LightSum::Kind::background, LightId::none(), "background", behind);
  add(LightSum::Kind::unlit, LightId::none(), "unlit", {1, 1, 1});
  return sums;
}

}  // namespace relook
