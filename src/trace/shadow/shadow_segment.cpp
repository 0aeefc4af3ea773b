#include "trace/shadow/shadow_segment.h"

#include <array>
#include <cmath>
#include <optional>

#include "trace/light/emission_source.h"
#include "trace/light/ray_light.h"

namespace relook {

namespace {

/// What a segment runs to, as seen from a hit.
struct Target {
  Direction way;  // any length
  bool has_place = true;
  Point at{0, 0, 0};  // where it has one
  float reach = 1;    // how far of the way
};

std::optional<Target> target_of_lamp(const RayNode& node, const RayLight& light) {
  if (!is_sampled(light, node)) return std::nullopt;
  if (traits_of(light.kind).has_place) return Target{light.position - node.point.position, true, light.position};
  return Target{-light.direction, false};
}

Target target_of(const RayNode& node, const RayLight& light, const LightSample& sample) {
  if (sample.distance == std::numeric_limits<float>::infinity()) return Target{sample.way, false};
  // Surfaces that shine would block the segments to them: those end a little before.
  constexpr float kBefore = 1.0F - 0x1p-12F;
  return Target{sample.way, true, node.point.position + sample.way * sample.distance, light.emission ? kBefore : 1.0F};
}

/// Does light from behind reach a hit by samples of its own? Where segments of the hit before it stand for all that is
/// let through, it does not.
bool lights_back(const RayNode& node, const RayLight& light) {
  const PathState& path = node.ray.path;
  return node.has_back && !(light.is_soft() ? path.is_wide || path.is_shut : path.has_lamps);
}

/// False where no sample of a light leads above the horizon of a hit, or, if it has a back, none at all.
bool may_face(const RayNode& node, const RayLight& light) {
  if (light.emission) return !light.emission->empty();
  if (light.environment) return light.environment->has_suns();
  if (!light.shape) return true;
  const SurfacePoint& point = node.point;
  return relook::shines_at(*light.shape, point.position) &&
         (node.has_back || !is_below(*light.shape, point.position, point.shading));
}

/// Lays a segment from a hit to what it runs to, if that faces the hit.
void lay(ShadowSegment& segment, const RayNode& node, const RayLight& light, const Target& target) {
  const SurfacePoint& point = node.point;
  const Direction& to_light = target.way;
  const bool is_above = point.shading.dot(to_light) > 0;
  if (!is_above && !node.has_back) return;
  const float height = point.geometric.dot(to_light) / std::sqrt(to_light.dot(to_light));
  if (is_above) {
    // A light near the horizon of the triangle is judged from the smooth surface.
    constexpr float kHorizon = 0.1F;  // cosine
    const float share = std::fmin(std::fmax(1.0F - height / kHorizon, 0.0F), 1.0F);
    segment.origin = point.position + point.lift * share + point.geometric * point.offset;
  } else if (height < 0 && lights_back(node, light)) {
    segment.origin = point.position - point.geometric * point.offset;
  } else {
    return;
  }
  segment.faces = true;
  segment.direction = target.has_place ? target.at - segment.origin : to_light;
  segment.t_max = target.has_place ? target.reach : std::numeric_limits<float>::infinity();
}

}  // namespace

ShadowSegment shadow_segment(const RayNode& node, const RayLight& light) {
  ShadowSegment segment;
  if (!light.is_soft()) {
    if (const auto target = target_of_lamp(node, light)) lay(segment, node, light, *target);
    return segment;
  }
  if (!may_face(node, light)) return segment;
  segment.sample = sample_light(light, node);
  if (segment.sample) lay(segment, node, light, target_of(node, light, *segment.sample));
  return segment;
}

void shadow_segments(std::span<const RayNode* const> nodes, const RayLight& light, std::span<ShadowSegment> segments) {
  if (!light.is_soft()) {
    for (std::size_t k = 0; k < nodes.size(); ++k) segments[k] = shadow_segment(*nodes[k], light);
    return;
  }
  std::array<const RayNode*, kMostTogether> facing;
  std::array<std::size_t, kMostTogether> which;
  std::array<std::optional<LightSample>, kMostTogether> samples;
  std::size_t count = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    segments[k].faces = false;
    if (!may_face(*nodes[k], light)) continue;
    which[count] = k;
    facing[count++] = nodes[k];
  }
  sample_light(light, std::span(facing).first(count), std::span(samples).first(count));
  for (std::size_t k = 0; k < count; ++k) {
    ShadowSegment& segment = segments[which[k]];
    segment.sample = samples[k];
    if (segment.sample) lay(segment, *facing[k], light, target_of(*facing[k], light, *segment.sample));
  }
}

void complete_filters(const RayScene& scene, const RayNode& node, const ShadowSegment& segment, FilterNode* filters,
                      std::size_t count) {
  const Direction way = segment.direction / std::sqrt(segment.direction.dot(segment.direction));
  for (std::size_t i = 0; i < count; ++i) {
    FilterNode& filter = filters[i];
    const RayObject& object = scene.object(filter.object);
    filter.point = surface_point(object, filter.hit, way);
    filter.footprint = node.footprint;  // no finer than what is shaded
    filter.cosine = -way.dot(filter.point.geometric);
    filter.length_inside = 0;
    if (!object.optics.volume || !filter.point.inside) continue;
    Point entry = segment.origin;
    for (std::size_t j = i; j-- > 0;) {
      if (filters[j].object != filter.object) continue;
      entry = filters[j].point.position;
      break;
    }
    const Direction inside = filter.point.position - entry;
    filter.length_inside = std::sqrt(inside.dot(inside));
  }
}

}  // namespace relook
