#include "trace/light/light_sample.h"

#include "trace/light/emission_source.h"

namespace relook {

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
    const float radiance = light.shape_radiance();
    return LightSample{point->direction, point->distance, point->density * rate, {radiance, radiance, radiance}};
  }
  if (light.environment) {
    const auto sun = light.environment->sample(u);
    if (!sun) return std::nullopt;
    return LightSample{to_world(sun->way, light.sine, light.cosine), std::numeric_limits<float>::infinity(),
                       sun->density * rate, light.environment->suns(sun->way)};
  }
  const auto emitter = light.emission->sample(from, u);
  if (!emitter) return std::nullopt;
  return LightSample{emitter->way, emitter->distance, emitter->density * rate, emitter->radiance};
}

}  // namespace relook
