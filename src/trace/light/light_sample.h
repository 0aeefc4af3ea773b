// Samples of lights with a size: a place that is lit in, a direction to the light out, and how likely it was.
#pragma once
#include <optional>
#include <span>

#include "light/point_set.h"
#include "trace/tree/ray_tree.h"

namespace relook {

struct RayLight;
struct RayNode;

struct LightSample {
  Direction way;            // unit, from the place to the sample
  float distance = 0;       // metres; infinity in the sky
  float density = 0;        // per steradian, times the light's rate
  std::uint32_t place = 0;  // of an emitting surface: its object's in the EmissionSource, and the point on it
  Hit hit;
};

/// Of a light with a size at a hit. None: the sample does not shine here, or the light's rate left it out. A pure
/// function of the hit's place, its sample and history, and the light.
[[nodiscard]] std::optional<LightSample> sample_light(const RayLight& light, const RayNode& node);
/// The same for several hits, of which suns are looked up side by side. Requires: as many samples as hits.
void sample_light(const RayLight& light, std::span<const RayNode* const> nodes,
                  std::span<std::optional<LightSample>> samples);
/// What comes from a sample at unit colour and intensity; of point and spot without range and cone.
[[nodiscard]] Color radiance_of(const RayLight& light, const LightSample& sample);

/// The share of hits that sample a light at all, and whether this one does.
[[nodiscard]] float sample_rate(const RayLight& light, const RayNode& node);
[[nodiscard]] bool is_sampled(const RayLight& light, const RayNode& node);

}  // namespace relook
