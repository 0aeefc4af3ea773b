#include "color/path/met_lights.h"

#include "base/portable_math.h"

namespace relook {

MetLights::MetLights(const ColorScene& scene) : scene_(scene) {
  for (std::uint32_t place = 0; place < scene.light_order().size(); ++place) {
    if (light_at(place).kind == LightKind::suns) suns_ = place;
    if (scene.light(place).shape) shapes_.push_back(place);
  }
}

MetLights::UnitLight MetLights::surroundings(const RayNode& node, Surroundings wanted) const {
  const PathState& path = node.ray.path;
  UnitLight unit;
  if (path.is_eye && scene_.scene().environment.background) {
    unit.has.background = wanted.background;
    if (wanted.background) unit.background = background(node.ray.direction);
    return unit;
  }
  if (!wanted.sky && !wanted.suns) return unit;
  const RayLight& light = scene_.light(suns_);
  const Direction way = to_image(node.ray.direction, light.sine, light.cosine);
  const EnvironmentLight::Parts parts = scene_.environment()->parts(way);
  unit.has.sky = wanted.sky;
  unit.sky = parts.sky;
  if (!wanted.suns || parts.suns == Color(0, 0, 0) || !may_meet(node, light, light_at(suns_))) return unit;
  const float weight = path.density > 0 ? met_weight(node, light, scene_.environment()->density(way)) : 1.0F;
  unit.has.suns = true;
  unit.suns = parts.suns * weight;
  return unit;
}

/// Radiance for unit tint.
Color MetLights::background(const Direction& way) const {
  const Background& behind = *scene_.scene().environment.background;
  if (!behind.image) return {1, 1, 1};
  const float turns = behind.rotation * 0.15915494F;
  const Direction local = to_image(way, portable_sin_turns(turns), portable_cos_turns(turns));
  const Rgba texel = sample(*behind.image, environment_uv(local), 0, {Wrap::repeat, Wrap::clamp});
  return {texel.r, texel.g, texel.b};
}

}  // namespace relook
