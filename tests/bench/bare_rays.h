// The yardstick of the full render: all its rays, shot in a bare loop of rtcIntersect1 / rtcOccluded1 at the same
// objects without any callback.
#pragma once
#include <cstdint>

#include "frame/image.h"
#include "scene/scene.h"

namespace relook {

struct BareRays {
  std::uint64_t rays = 0, shadow_segments = 0;
  double seconds = 0;  // of the fastest of the passes, all threads
};

/// `image`: preprocessed from `scene`; its stored segments are the rays.
[[nodiscard]] BareRays time_bare_rays(const Scene& scene, const Image& image, int passes);

}  // namespace relook
