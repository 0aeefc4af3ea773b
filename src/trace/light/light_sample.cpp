#include "trace/light/light_sample.h"

#include <algorithm>
#include <array>

#include "light/point_lanes.h"
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

namespace {

/// Hits that are sampled together.
constexpr std::size_t kTogether = kPointLanes;

LightSample sample_of(const EnvironmentLight::Sun& sun, const RayLight& light, const RayNode& node) {
  return {to_world(sun.way, light.sine, light.cosine), std::numeric_limits<float>::infinity(),
          sun.density * sample_rate(light, node), 0, {}};
}

/// Of what is sampled hit by hit, for a point of the unit square.
std::optional<LightSample> sample_at(const RayLight& light, const RayNode& node, const Uv& u) {
  const Point& from = node.point.position;
  const float rate = sample_rate(light, node);
  if (light.shape) {
    const auto point = sample(*light.shape, from, u);
    if (!point) return std::nullopt;
    return LightSample{point->direction, point->distance, point->density * rate, 0, {}};
  }
  if (light.environment) {
    const auto sun = light.environment->sample(u);
    if (!sun) return std::nullopt;
    return sample_of(*sun, light, node);
  }
  auto emitted = light.emission->sample(from, u);
  if (emitted) emitted->density *= rate;
  return emitted;
}

/// `samples`: none yet.
void sample_suns(const RayLight& light, std::span<const RayNode* const> nodes, const PointLanes& points,
                 std::span<std::optional<LightSample>> samples) {
  std::array<std::size_t, kTogether> which;
  std::array<Uv, kTogether> u;
  std::array<std::optional<EnvironmentLight::Sun>, kTogether> suns;
  std::size_t count = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!is_sampled(light, *nodes[k])) continue;
    which[count] = k;
    u[count++] = points.at(k);
  }
  light.environment->sample(std::span(u).first(count), std::span(suns).first(count));
  for (std::size_t k = 0; k < count; ++k)
    if (suns[k]) samples[which[k]] = sample_of(*suns[k], light, *nodes[which[k]]);
}

void sample_some(const RayLight& light, std::span<const RayNode* const> nodes,
                 std::span<std::optional<LightSample>> samples) {
  PointKeys keys;
  for (std::size_t k = 0; k < nodes.size(); ++k) keys.set(k, nodes[k]->ray.path.key, nodes[k]->ray.path.history);
  PointLanes points;
  sample_points(keys, Purpose::light, light.name, points);
  if (!light.shape && light.environment) return sample_suns(light, nodes, points, samples);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (is_sampled(light, *nodes[k])) samples[k] = sample_at(light, *nodes[k], points.at(k));
}

}  // namespace

std::optional<LightSample> sample_light(const RayLight& light, const RayNode& node) {
  if (!is_sampled(light, node)) return std::nullopt;
  const PathState& path = node.ray.path;
  return sample_at(light, node, sample_point(path.key, path.history, Purpose::light, light.name));
}

void sample_light(const RayLight& light, std::span<const RayNode* const> nodes,
                  std::span<std::optional<LightSample>> samples) {
  std::ranges::fill(samples, std::nullopt);
  for (std::size_t first = 0; first < nodes.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, nodes.size() - first);
    sample_some(light, nodes.subspan(first, count), samples.subspan(first, count));
  }
}

Color radiance_of(const RayLight& light, const LightSample& sample) {
  if (light.shape) return Color(light.shape_radiance());
  if (light.environment) return light.environment->suns(to_image(sample.way, light.sine, light.cosine));
  return light.emission->radiance(sample.place, sample.hit);
}

}  // namespace relook
