// The bare minimum of an exact update that traces what changes afresh: tracing and shading just these pixels.
#pragma once
#include <cstdint>
#include <span>

#include "frame/image.h"
#include "scene/scene.h"

namespace relook {

/// Seconds, all threads, of the fastest of three passes, without the acceleration structures. `pixels`: indices into
/// the frame.
[[nodiscard]] double time_pixel_work(const Scene& scene, const ViewOptions& view,
                                     std::span<const std::uint32_t> pixels);

}  // namespace relook
