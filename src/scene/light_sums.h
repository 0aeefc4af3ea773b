// The sums that a frame of Integrator::path is made of: one for each light that does not share, one for all lights that
// name the same (Light::sum), and four for light that has no rays of its own. Written by rendering, weighted by the
// colours that stand here, added in this order.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace relook {

/// One term of a frame: color times the sum of the unit light that reaches a pixel. Without a background of its own,
/// its sum is empty and its colour black, and the camera sees sky and suns.
struct LightSum {
  enum class Kind : std::uint8_t { light, shared, sky, ambient, background, unlit } kind = Kind::light;
  LightId light;                        // kind light: this one
  std::string shared;                   // kind shared: the Light::sum of those that have it
  std::string name;                     // of a layer: no two are alike, fit for channels of OpenEXR
  std::array<double, 3> color{1, 1, 1}; // linear RGB: colour times intensity; 1 of unlit and of those that are shared,
                                        // whose terms have the colours of their lights
};

/// The sums of a scene of Integrator::path, in their order: the lamps and areas of Scene::light_order that share none,
/// the shared sums by their names, sky, suns, emission; then ambient, background and unlit, which are always there.
[[nodiscard]] std::vector<LightSum> light_sums(const Scene& scene);

/// How many more living lights than sums of lights there are.
[[nodiscard]] std::size_t lights_in_shared_sums(const Scene& scene);

/// Colour times intensity, linear RGB.
[[nodiscard]] std::array<double, 3> color_of_light(const Light& light);

}  // namespace relook
