#include "trace/light/ray_light.h"

#include <cmath>
#include <numbers>

#include "base/portable_math.h"
#include "light/point_set.h"

namespace relook {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// 1 - cos of half an angle in radians.
float half_versine(float angle) {
  const float sine = portable_sin_turns(angle * (0.125F / kPi));
  return 2.0F * sine * sine;
}

std::optional<LightShape> shape_of(const Light& light) {
  if (light.kind == LightKind::rect) return RectShape(light.position, light.up, light.right);
  if (light.kind == LightKind::disk) return DiskShape(light.position, light.up, light.right);
  const LightTraits& traits = traits_of(light.kind);
  if (traits.has_radius && light.radius > 0) return SphereShape(light.position, light.radius);
  if (traits.has_angle && light.angle > 0) return SkyDisc(-light.direction, half_versine(light.angle));
  return std::nullopt;
}

}  // namespace

RayLight::RayLight(const Light& light, Integrator integrator)
    : kind(light.kind), position(light.position), direction(light.direction) {
  if (integrator != Integrator::path) return;
  name = name_hash(light.kind == LightKind::emission ? "emission/" + light.light
                   : light.kind == LightKind::suns   ? std::string("suns/")
                                                     : "light/" + light.node);
  rate = light.rate;
  radius = light.radius;
  angle = light.angle;
  right = light.right;
  up = light.up;
  shape = shape_of(light);
  sine = portable_sin_turns(light.rotation * (0.5F / kPi));
  cosine = portable_cos_turns(light.rotation * (0.5F / kPi));
}

float RayLight::shape_radiance() const {
  if (traits_of(kind).has_size) return 1;
  if (traits_of(kind).has_radius) return 1.0F / (kPi * radius * radius);
  // The irradiance of a disc of radiance 1 on a plane across it is pi sin^2 of half its angle.
  const float versine = half_versine(angle);
  return 1.0F / (kPi * versine * (2.0F - versine));
}

bool RayLight::same_place(const RayLight& other) const {
  return kind == other.kind && position == other.position && direction == other.direction && name == other.name &&
         rate == other.rate && radius == other.radius && angle == other.angle && right == other.right &&
         up == other.up && environment == other.environment && sine == other.sine && cosine == other.cosine &&
         emission == other.emission;
}

}  // namespace relook
