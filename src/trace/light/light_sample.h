// Samples of lights with a size: a place that is lit in, a direction to the light out, and how likely it was.
#pragma once
#include <optional>

#include "light/point_set.h"
#include "trace/light/ray_light.h"
#include "trace/tree/tree_block.h"

namespace relook {

struct LightSample {
  Direction way;         // unit, from the place to the sample
  float distance = 0;    // metres; infinity in the sky
  float density = 0;     // per steradian, times the light's rate
  Color radiance;        // from there, at unit colour and intensity; of point and spot without range and cone
};

/// Of a light with a size at a hit. None: the sample does not shine here, or the light's rate left it out. A pure
/// function of the hit's place, its sample and history, and the light.
[[nodiscard]] std::optional<LightSample> sample_light(const RayLight& light, const RayNode& node);

/// The share of hits that sample a light at all, and whether this one does.
[[nodiscard]] inline float sample_rate(const RayLight& light, const RayNode& node) {
  return node.ray.path.from.is_none() ? 1.0F : light.rate;
}
[[nodiscard]] bool is_sampled(const RayLight& light, const RayNode& node);

}  // namespace relook
