// Shadow segments: a surface point and a light in, the segment that is traced between them out; and what transparent
// surfaces on it need for their tints.
#pragma once
#include <cstddef>

#include "trace/tree/tree_block.h"

namespace relook {

/// The shadow segment from a point to a light: t runs to 1 at a point or spot light.
struct ShadowSegment {
  bool faces = false;  // the light is above the smooth surface
  Point origin{0, 0, 0};
  Direction direction{0, 0, 1};
  float t_max = 1;
};
[[nodiscard]] ShadowSegment shadow_segment(const SurfacePoint& point, const RayLight& light);
/// True where no light is gathered and no segments are kept: the inner side of a volume.
[[nodiscard]] inline bool is_interface_only(const RayObject& object, const SurfacePoint& point) {
  return object.optics.volume && point.inside;
}

/// Completes the `count` filters of one segment of `node`, in its order: points, footprints, lengths inside volumes.
void complete_filters(const RayScene& scene, const RayNode& node, const ShadowSegment& segment, FilterNode* filters,
                      std::size_t count);

}  // namespace relook
