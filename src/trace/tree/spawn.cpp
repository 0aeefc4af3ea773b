#include "trace/tree/spawn.h"

#include <cmath>

#include "physics/dispersion.h"
#include "physics/fresnel.h"
#include "physics/mirror.h"

namespace relook {
namespace {

constexpr float kFresnelCut = 1e-3F;

/// What a coat reflects at a cosine of at most 1, towards the cut-off. The weight is that of schlick() but for the
/// order of the products, which decides its last bits.
float coat_term(float cosine) {
  const float m = 1.0F - cosine;
  return coat_reflectance(m * m * m * m * m);
}

Normal normal_of_slot(const RayNode& node, const RayObject& object, Slot slot, float scale) {
  const TextureSlot& map = object.material->slot(slot);
  if (map.kind == TextureKind::none) return node.point.shading;
  const Rgba texel = texture_value(map, texture_coordinates(object, node.hit, node.point.local, map), node.footprint);
  return mapped_normal(tangent_frame(object, node.hit, node.point, map), node.point, texel, scale);
}

/// The index of refraction for a channel; all of them: that of the middle.
float channel_ior(const SurfaceOptics& optics, Channel channel) {
  if (channel == Channel::red) return red_ior(optics.ior, optics.dispersion);
  return channel == Channel::blue ? blue_ior(optics.ior, optics.dispersion) : optics.ior;
}

/// Collects the rays of one hit.
class Spawner {
 public:
  Spawner(const RayNode& node, const RayObject& object, std::uint32_t max_depth)
      : node_(node), object_(object), may_spawn_(node.ray.generation < max_depth) {}

  /// `side`: +1 leaves on the side of the incoming ray, -1 on the other. `fresnel`: factor towards the cut-off.
  void add(Branch branch, const Direction& direction, float side, float fresnel) {
    SpawnedRay* ray = add(branch, fresnel);
    if (ray == nullptr) return;
    ray->origin = node_.point.position + node_.point.geometric * (side * node_.point.offset);
    ray->direction = direction;
    ray->cone_width = node_.ray.cone_width + node_.ray.cone_spread * node_.length;
  }
  /// A ray that goes straight on.
  void add_straight(Branch branch, float fresnel) {
    SpawnedRay* ray = add(branch, fresnel);
    if (ray == nullptr) return;
    ray->origin = node_.ray.origin;
    ray->direction = node_.ray.direction;
    ray->cone_width = node_.ray.cone_width;
    ray->start = node_.ray.start;
    ray->end = node_.ray.end;
    ray->behind = {node_.object, node_.hit, node_.t, object_.key};
    ray->travelled = node_.length;
    ray->travelled_slack = distance_slack(node_, object_);
  }
  [[nodiscard]] const Spawned& result() const { return spawned_; }

 private:
  /// Null if there is none.
  SpawnedRay* add(Branch branch, float fresnel) {
    if (!may_spawn_) return nullptr;
    const float product = node_.ray.fresnel_product * fresnel;
    if (product < kFresnelCut) {
      spawned_.cut.add(branch);
      return nullptr;
    }
    SpawnedRay& ray = spawned_.rays[static_cast<std::size_t>(branch)];
    ray.cone_spread = node_.ray.cone_spread;
    ray.fresnel_product = product;
    ray.generation = static_cast<std::uint8_t>(node_.ray.generation + 1);
    ray.branch = branch;
    ray.channel = channel_of(branch, node_.ray.channel);
    spawned_.branches.add(branch);
    return &ray;
  }

  const RayNode& node_;
  const RayObject& object_;
  bool may_spawn_;
  Spawned spawned_;
};

}  // namespace

Spawned spawn(const RayNode& node, const RayObject& object, std::uint32_t max_depth) {
  const SurfaceOptics& optics = object.optics;
  Spawner spawner(node, object, max_depth);
  if (!optics.spawns()) return spawner.result();
  const Material& material = *object.material;
  const Direction d = node.ray.direction;
  const Normal n = normal_of_slot(node, object, Slot::normal, material.normal_scale);
  const float cosine = std::fmax(-d.dot(n), kLeastCosine);
  const bool parts = optics.dispersion > 0 && node.ray.channel == Channel::all;
  const auto eta_of = [&](Channel channel) {
    const float ior = channel_ior(optics, channel);
    return node.point.inside && optics.bent ? 1.0F / ior : ior;
  };
  // From the inside of a smooth solid, light leaves where the triangle or its vertex normals let it.
  const float flat_cosine = node.point.inside ? -d.dot(node.point.geometric) : 0.0F;
  const auto reflectance_of = [&](float eta) {
    return optics.refracts ? dielectric_reflectance(std::fmin(std::fmax(cosine, flat_cosine), 1.0F), eta) : 1.0F;
  };
  const float own_eta = eta_of(node.ray.channel), reflectance = reflectance_of(own_eta);
  const float counted = optics.counts_in_cutoff ? 1.0F : 0.0F;
  const auto factor = [&](float term) { return 1.0F - counted + counted * term; };

  if (optics.reflects) {
    float most = reflectance;
    if (parts)
      for (const Channel channel : kChannels) most = std::fmax(most, reflectance_of(eta_of(channel)));
    spawner.add(Branch::reflection, mirrored(d, n, node.point.geometric), 1.0F, factor(most));
  }
  if (optics.coat_reflects && !node.point.inside) {
    const Normal coat = normal_of_slot(node, object, Slot::clearcoat_normal, material.clearcoat_normal_scale);
    spawner.add(Branch::coat, mirrored(d, coat, node.point.geometric), 1.0F,
                coat_term(std::fmin(std::fmax(-d.dot(coat), kLeastCosine), 1.0F)));
  }
  const auto refract = [&](Branch branch, float eta, float passed) {
    if (!optics.bent) return spawner.add_straight(branch, passed);
    const bool is_flat = flat_cosine > cosine && sin2_behind(std::fmin(cosine, 1.0F), eta) >= 1.0F;
    const float c = std::fmin(is_flat ? flat_cosine : cosine, 1.0F);
    const float sin2 = sin2_behind(c, eta);
    if (sin2 >= 1.0F) return;
    const Normal& towards = is_flat ? node.point.geometric : n;
    const Direction bent = d * (1.0F / eta) + towards * (c / eta - std::sqrt(1.0F - sin2));
    // A bent shading normal may send the ray back to its own side: then it goes straight on.
    const bool goes_through = bent.dot(node.point.geometric) < 0;
    if (goes_through)
      spawner.add(branch, unit(bent), -1.0F, passed);
    else
      spawner.add_straight(branch, passed);
  };
  if (optics.refracts && !parts) refract(Branch::refraction, own_eta, factor(1.0F - reflectance));
  if (optics.transparent) spawner.add_straight(Branch::transparency, 1.0F);
  if (optics.refracts && parts)
    for (const Channel channel : kChannels) {
      const float eta = eta_of(channel);
      refract(refracted(channel), eta, factor(1.0F - reflectance_of(eta)));
    }
  return spawner.result();
}

}  // namespace relook
