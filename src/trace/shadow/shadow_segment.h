// Shadow segments: a surface point and a light in, the segment that is traced between them out; and what transparent
// surfaces on it need for their tints.
#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "trace/tree/tree_block.h"

namespace relook {

/// The shadow segment from a hit to a light, or to its sample: t runs to 1 where that has a place.
struct ShadowSegment {
  bool faces = false;  // the light is sampled at all, and above the smooth surface, or behind a surface that has a back
  Point origin{0, 0, 0};
  Direction direction{0, 0, 1};
  float t_max = 1;
  std::optional<LightSample> sample;  // of a light with a size, which rays may meet

  [[nodiscard]] Ray ray() const {
    Ray ray{origin, direction, t_max};
    ray.from_light = !sample;
    return ray;
  }
};
inline constexpr std::size_t kMostTogether = 16;
[[nodiscard]] ShadowSegment shadow_segment(const RayNode& node, const RayLight& light);
/// The same from several hits, at most kMostTogether. Requires: as many segments as hits.
void shadow_segments(std::span<const RayNode* const> nodes, const RayLight& light, std::span<ShadowSegment> segments);
/// False where no light is gathered and no segments are kept: the inner side of a volume, and where rays only gather or
/// pass.
[[nodiscard]] inline bool is_lit(const RayObject& object, const RayNode& node) {
  return !(object.optics.volume && node.point.inside) && !node.ray.path.gathers && node.coverage.sees_surface();
}

/// Completes the `count` filters of one segment of `node`, in its order: points, footprints, lengths inside volumes.
void complete_filters(const RayScene& scene, const RayNode& node, const ShadowSegment& segment, FilterNode* filters,
                      std::size_t count);

}  // namespace relook
