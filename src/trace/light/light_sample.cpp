#include "trace/light/light_sample.h"

#include "trace/light/emission_source.h"
#include "trace/light/ray_light.h"
#include "trace/tree/tree_block.h"

namespace relook {

float sample_rate(const RayLight& light, const RayNode& node) {
  return node.ray.path.from.is_none() ? 1.0F : light.rate;
}

bool is_sampled(const RayLight& light, const RayNode& node) {
  const float rate = sample_rate(light, node);
  const PathState& path = node.ray.path;
  return rate >= 1 || sample_number(path.key, path.history, Purpose::light, light.name) < rate;
}

std::optional<LightSample> sample_light(const RayLight& light, const RayNode& node) {
  if (!is_sampled(light, node)) return std::nullopt;
  const PathState& path = node.ray.path;
  const Point& from = node.point.position;
  const Uv u = sample_point(path.key, path.history, Purpose::light, light.name);
  const float rate = sample_rate(light, node);
  if (light.shape) {
    const auto point = sample(*light.shape, from, u);
    if (!point) return std::nullopt;
    return LightSample{point->direction, point->distance, point->density * rate, 0, {}};
  }
  if (light.environment) {
    const auto sun = light.environment->sample(u);
    if (!sun) return std::nullopt;
    return LightSample{to_world(sun->way, light.sine, light.cosine), std::numeric_limits<float>::infinity(),
                       sun->density * rate, 0, {}};
  }
  auto emitted = light.emission->sample(from, u);
  if (emitted) emitted->density *= rate;
  return emitted;
}

Color radiance_of(const RayLight& light, const LightSample& sample) {
  if (light.shape) return Color(light.shape_radiance());
  if (light.environment) return light.environment->suns(to_image(sample.way, light.sine, light.cosine));
  return light.emission->radiance(sample.place, sample.hit);
}

}  // namespace relook
