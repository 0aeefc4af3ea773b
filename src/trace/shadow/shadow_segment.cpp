#include "trace/shadow/shadow_segment.h"

#include <cmath>

namespace relook {

ShadowSegment shadow_segment(const SurfacePoint& point, const RayLight& light) {
  ShadowSegment segment;
  const bool directional = !traits_of(light.kind).has_place;
  const Direction to_light = directional ? -light.direction : light.position - point.position;
  segment.faces = point.shading.dot(to_light) > 0;
  // A light near the horizon of the triangle is judged from the smooth surface.
  constexpr float kHorizon = 0.1F;  // cosine
  const float height = point.geometric.dot(to_light) / std::sqrt(to_light.dot(to_light));
  const float share = std::fmin(std::fmax(1.0F - height / kHorizon, 0.0F), 1.0F);
  segment.origin = point.position + point.lift * share + point.geometric * point.offset;
  segment.direction = directional ? to_light : light.position - segment.origin;
  segment.t_max = directional ? std::numeric_limits<float>::infinity() : 1.0F;
  return segment;
}

void complete_filters(const RayScene& scene, const RayNode& node, const ShadowSegment& segment, FilterNode* filters,
                      std::size_t count) {
  const Direction way = segment.direction / std::sqrt(segment.direction.dot(segment.direction));
  for (std::size_t i = 0; i < count; ++i) {
    FilterNode& filter = filters[i];
    const RayObject& object = scene.object(filter.object);
    filter.point = surface_point(object, filter.hit, way);
    filter.footprint = node.footprint;  // no finer than what is shaded
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
