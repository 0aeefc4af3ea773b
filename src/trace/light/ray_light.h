// A light as rays need it: where it is, what shape it has, and how its samples are told apart. Derived from Scene by
// RayScene; colours are not in it.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "light/environment_light.h"
#include "light/light_shape.h"
#include "scene/integrator.h"
#include "scene/light.h"

namespace relook {

class EmissionSource;

/// What shadow segments and rays that meet a light need of it.
struct RayLight {
  LightKind kind = LightKind::point;
  Point position{0, 0, 0};        // where it has a place
  Direction direction{0, 0, -1};  // where it has one: unit, the way the light travels
  // Of the path integrator:
  std::uint64_t name = 0;                             // hash of its name, by which its samples are told apart
  float rate = 1;                                     // of samples behind the first scattering
  float radius = 0, angle = 0;                        // as Light's
  Direction right{0, 0, 0}, up{0, 0, 0};              // as Light's
  std::optional<LightShape> shape;                    // of a lamp or area with a size
  std::shared_ptr<const EnvironmentLight> environment;  // of suns
  float sine = 0, cosine = 1;                         // of suns: of the image's rotation
  std::shared_ptr<const EmissionSource> emission;     // of emission

  RayLight() = default;
  /// Without what follows from other things than the light: environment and emission.
  RayLight(const Light& light, Integrator integrator = Integrator::whitted);

  /// Is it sampled, and met by rays?
  [[nodiscard]] bool is_soft() const { return shape || environment || emission; }
  /// The radiance of its shape at unit colour and intensity.
  [[nodiscard]] float shape_radiance() const;
  [[nodiscard]] bool same_place(const RayLight& other) const;
};

/// Directions of the world in those of an environment's image, and back. `sine`, `cosine`: of its rotation.
[[nodiscard]] inline Direction to_image(const Direction& d, float sine, float cosine) {
  return {d.x * cosine - d.z * sine, d.y, d.z * cosine + d.x * sine};
}
[[nodiscard]] inline Direction to_world(const Direction& d, float sine, float cosine) {
  return {d.x * cosine + d.z * sine, d.y, d.z * cosine - d.x * sine};
}

}  // namespace relook
