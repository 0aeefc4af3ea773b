#include "trace/tree/spawn.h"

#include <cmath>

#include "physics/fresnel.h"
#include "physics/mirror.h"
#include "trace/shadow/shadow_segment.h"
#include "trace/tree/lobes.h"
#include "trace/vertex_texels.h"

namespace relook {
namespace {

constexpr float kFresnelCut = 1e-3F;

/// What a coat reflects at a cosine of at most 1, towards the cut-off. The weight is that of schlick() but for the
/// order of the products, which decides its last bits.
float coat_term(float cosine) {
  const float m = 1.0F - cosine;
  return coat_reflectance(m * m * m * m * m);
}

Normal normal_of_slot(const RayNode& node, const RayObject& object, const VertexTexels& texels, Slot slot,
                      float scale) {
  const TextureSlot& map = object.material->slot(slot);
  if (map.kind == TextureKind::none) return node.point.shading;
  const TangentFrame frame = tangent_frame(object, node.hit, node.point, map);
  return mapped_normal(frame, node.point, texels.at(slot), scale);
}
Normal base_normal(const RayNode& node, const RayObject& object, const VertexTexels& texels) {
  return normal_of_slot(node, object, texels, Slot::normal, object.material->normal_scale);
}
Normal coat_normal(const RayNode& node, const RayObject& object, const VertexTexels& texels) {
  return normal_of_slot(node, object, texels, Slot::clearcoat_normal, object.material->clearcoat_normal_scale);
}
/// Of what a hit of the path integrator reads to find its lobes.
VertexTexels texels_of_lobes(const RayNode& node, const RayObject& object) {
  return {node, object, {Slot::normal, Slot::metallic_roughness, Slot::clearcoat_normal, Slot::clearcoat_roughness}};
}

/// Collects the rays of one hit.
class Spawner {
 public:
  /// `may_spawn`: is it deep enough for another generation?
  Spawner(const RayNode& node, const RayObject& object, bool may_spawn, Spawned& spawned)
      : node_(node), object_(object), may_spawn_(may_spawn), spawned_(spawned) {}

  /// `side`: +1 leaves on the side of the incoming ray, -1 on the other. `fresnel`: factor towards the cut-off. Null if
  /// there is none.
  SpawnedRay* add(Branch branch, const Direction& direction, float side, float fresnel) {
    SpawnedRay* ray = add(branch, fresnel);
    if (ray == nullptr) return nullptr;
    ray->origin = left_at(node_.point, side);
    ray->direction = direction;
    ray->cone_width = node_.ray.cone_width + node_.ray.cone_spread * node_.length;
    return ray;
  }
  /// A ray that goes straight on.
  SpawnedRay* add_straight(Branch branch, float fresnel) {
    SpawnedRay* ray = add(branch, fresnel);
    if (ray != nullptr) go_straight(node_, object_, *ray);
    return ray;
  }
  void set_may_spawn(bool may_spawn) { may_spawn_ = may_spawn; }

 private:
  /// Null if there is none.
  SpawnedRay* add(Branch branch, float fresnel) {
    if (!may_spawn_) return nullptr;
    const float product = node_.ray.fresnel_product * fresnel;
    if (product < kFresnelCut) {
      spawned_.cut.add(branch);
      return nullptr;
    }
    SpawnedRay& ray = spawned_.add(branch);
    ray.cone_spread = node_.ray.cone_spread;
    ray.fresnel_product = product;
    ray.generation = static_cast<std::uint8_t>(node_.ray.generation + 1);
    ray.branch = branch;
    ray.channel = channel_of(branch, node_.ray.channel);
    ray.path = node_.ray.path;
    ray.path.history = child_history(node_.ray.path.history, static_cast<std::uint32_t>(branch));
    return &ray;
  }

  const RayNode& node_;
  const RayObject& object_;
  bool may_spawn_;
  Spawned& spawned_;
};


/// A hit on its way to the rays that leave it: its normal with the map, cosines, and how much it reflects.
class Interface {
 public:
  Interface(const RayNode& node, const RayObject& object, const VertexTexels& texels)
      : node_(node),
        optics_(object.optics),
        normal_(base_normal(node, object, texels)),
        cosine_(std::fmax(-node.ray.direction.dot(normal_), kLeastCosine)),
        // From the inside of a smooth solid, light leaves where the triangle or its vertex normals let it.
        flat_cosine_(node.point.inside ? -node.ray.direction.dot(node.point.geometric) : 0.0F),
        parts_(optics_.dispersion > 0 && node.ray.channel == Channel::all) {}

  [[nodiscard]] const Normal& normal() const { return normal_; }
  /// How much of the terms that count towards the cut-off `term` is.
  [[nodiscard]] float factor(float term) const {
    const float counted = optics_.counts_in_cutoff ? 1.0F : 0.0F;
    return 1.0F - counted + counted * term;
  }
  /// Of the channel that reflects most.
  [[nodiscard]] float reflectance() const {
    float most = reflectance_of(eta_of(node_.ray.channel));
    if (parts_)
      for (const Channel channel : kChannels) most = std::fmax(most, reflectance_of(eta_of(channel)));
    return most;
  }
  /// The refracted ray, or those of the channels. Each is handed to refracted(ray), which may get null.
  template <class Refracted>
  void refract(Spawner& spawner, bool parted, const Refracted& done) const {
    if (!optics_.refracts || parted != parts_) return;
    if (!parts_) {
      const float eta = eta_of(node_.ray.channel);
      done(refract(spawner, Branch::refraction, eta, factor(1.0F - reflectance_of(eta))));
      return;
    }
    for (const Channel channel : kChannels) {
      const float eta = eta_of(channel);
      done(refract(spawner, refracted(channel), eta, factor(1.0F - reflectance_of(eta))));
    }
  }

 private:
  [[nodiscard]] float eta_of(Channel channel) const {
    const float ior = channel_ior(optics_, channel);
    return node_.point.inside && optics_.bent ? 1.0F / ior : ior;
  }
  [[nodiscard]] float reflectance_of(float eta) const {
    return optics_.refracts ? dielectric_reflectance(std::fmin(std::fmax(cosine_, flat_cosine_), 1.0F), eta) : 1.0F;
  }
  SpawnedRay* refract(Spawner& spawner, Branch branch, float eta, float passed) const {
    if (!optics_.bent) return spawner.add_straight(branch, passed);
    const bool is_flat = flat_cosine_ > cosine_ && sin2_behind(std::fmin(cosine_, 1.0F), eta) >= 1.0F;
    const float c = std::fmin(is_flat ? flat_cosine_ : cosine_, 1.0F);
    const float sin2 = sin2_behind(c, eta);
    if (sin2 >= 1.0F) return nullptr;
    const Normal& towards = is_flat ? node_.point.geometric : normal_;
    const Direction bent = node_.ray.direction * (1.0F / eta) + towards * (c / eta - std::sqrt(1.0F - sin2));
    // A bent shading normal may send the ray back to its own side: then it goes straight on.
    if (bent.dot(node_.point.geometric) < 0) return spawner.add(branch, unit(bent), -1.0F, passed);
    return spawner.add_straight(branch, passed);
  }

  const RayNode& node_;
  const SurfaceOptics& optics_;
  Normal normal_;
  float cosine_, flat_cosine_;
  bool parts_;
};

void spawn_whitted(const RayNode& node, const RayObject& object, const SpawnRule& rule, Spawned& spawned) {
  const SurfaceOptics& optics = object.optics;
  Spawner spawner(node, object, node.ray.generation < rule.max_depth, spawned);
  if (!optics.spawns()) return;
  const Direction d = node.ray.direction;
  const VertexTexels texels(node, object, {Slot::normal});
  const Interface interface(node, object, texels);
  if (optics.reflects)
    spawner.add(Branch::reflection, mirrored(d, interface.normal(), node.point.geometric), 1.0F,
                interface.factor(interface.reflectance()));
  if (optics.coat_reflects && !node.point.inside) {
    const Normal coat = coat_normal(node, object, texels);
    spawner.add(Branch::coat, mirrored(d, coat, node.point.geometric), 1.0F,
                coat_term(std::fmin(std::fmax(-d.dot(coat), kLeastCosine), 1.0F)));
  }
  interface.refract(spawner, false, [](SpawnedRay*) {});
  if (optics.transparent) spawner.add_straight(Branch::transparency, 1.0F);
  interface.refract(spawner, true, [](SpawnedRay*) {});
}

Branch branch_of(Lobe lobe, const VertexLobes& lobes) {
  switch (lobe) {
    case Lobe::diffuse:
      return Branch::diffuse;
    case Lobe::specular:
      return Branch::reflection;
    case Lobe::coat:
      return Branch::coat;
    case Lobe::transmission:
      break;
  }
  return lobes.is_channel_chosen ? refracted(lobes.channel) : Branch::refraction;
}

/// The end of a ray's way: after that many bounces of a kind, or of all, it gathers.
bool ends(const PathState& path, const RayNode& from, const SpawnRule& rule) {
  return path.diffuse > rule.diffuse_depth || path.glossy > rule.glossy_depth ||
         path.transmission > rule.transmission_depth || from.ray.generation >= rule.max_depth;
}

/// What stands for the way of a transmitted lobe ray beside itself. `is_sampled`: its hit gathers light along it.
void note_transmission(PathState& path, const PathState& from, bool is_sampled, bool is_wide) {
  path.is_alone = !is_sampled;
  path.is_shut = from.is_shut || from.is_wide;
  path.is_wide = is_wide && is_sampled && !path.is_shut;
  path.has_lamps = from.has_lamps || is_sampled;
}

/// The ray of a lobe that has been chosen, from a hit that scatters.
void add_lobe_ray(Spawner& spawner, const RayNode& node, const RayObject& object, const VertexLobes& lobes,
                  const SpawnRule& rule, float fresnel) {
  const PathState& from = node.ray.path;
  const auto sample = sample_lobe(lobes, node.point.geometric, sample_point(from.key, from.history, Purpose::lobe));
  if (!sample) return;
  const Lobe lobe = sample->lobe;
  const bool is_through = lobe == Lobe::transmission;
  // Behind the last vertex, too, a ray gathers what shines where it ends.
  spawner.set_may_spawn(true);
  const float counted = lobe == Lobe::specular ? fresnel : 1.0F;
  SpawnedRay* ray = spawner.add(branch_of(lobe, lobes), sample->way, is_through ? -1.0F : 1.0F, counted);
  if (ray == nullptr) return;
  PathState& path = ray->path;
  path.straight = straight_behind(from);
  path.from = node.object;
  path.density = sample->density;
  path.is_first = from.from.is_none();
  path.is_eye = false;
  const float height = node.point.shading.dot(sample->way);
  if (is_through) {
    note_transmission(path, from, node.has_back && height < 0, lobes.is_wide(lobe));
  } else {
    path.is_shut = false;
    path.is_alone = !is_lit(object, node) || !(height > 0);
    path.is_wide = lobes.is_wide(lobe) && !path.is_alone;
    path.has_lamps = !path.is_alone;
  }
  path.alpha_floor = std::fmax(
      from.alpha_floor, lobe == Lobe::diffuse ? kAlphaFloorBehindDiffuse : alpha_floor_behind(lobes.bucket(lobe)));
  const float spread =
      lobe == Lobe::diffuse ? kConeSpreadBehindDiffuse : cone_spread_behind(lobes.bucket(lobe));
  ray->cone_spread = std::fmax(ray->cone_spread, spread);
  ++(lobe == Lobe::diffuse ? path.diffuse : is_through ? path.transmission : path.glossy);
  path.gathers = ends(path, node, rule);
}

/// A proportion of blinn-phong: a mirror.
void add_mirror_ray(Spawner& spawner, const RayNode& node, const Normal& normal) {
  SpawnedRay* ray =
      spawner.add(Branch::reflection, mirrored(node.ray.direction, normal, node.point.geometric), 1.0F, 1.0F);
  if (ray == nullptr) return;
  ray->path.straight = straight_behind(node.ray.path);
  ray->path.from = node.object;
  ray->path.density = 0;
  ray->path.is_eye = ray->path.is_shut = ray->path.is_wide = ray->path.has_lamps = false;
}

/// A ray through a surface that turns rays: a segment through it counts as turned, whichever way this one goes.
void note_refraction(SpawnedRay* ray) {
  if (ray == nullptr) return;
  PathState& path = ray->path;
  path.is_shut = path.is_shut || path.is_wide;
  path.is_wide = false;
  path.density = 0;
  if (!ray->goes_on()) path.is_eye = false;
}

/// The straight ray of what is transparent. By coverage alone it is no new generation, and has a limit of its own.
SpawnedRay* add_straight_ray(Spawner& spawner, const RayNode& node, const RayObject& object, bool is_deep) {
  const bool by_coverage = passes_by_coverage(*object.material);
  spawner.set_may_spawn(by_coverage ? node.ray.path.straight < kMostStraight : !is_deep);
  SpawnedRay* ray = spawner.add_straight(Branch::transparency, 1.0F);
  spawner.set_may_spawn(!is_deep);
  if (ray == nullptr || !by_coverage) return ray;
  ray->generation = node.ray.generation;
  ++ray->path.straight;
  return ray;
}

/// One lobe is followed, and, beside it, what goes through the surface.
void spawn_path(const RayNode& node, const RayObject& object, const SpawnRule& rule, Spawned& spawned) {
  const SurfaceOptics& optics = object.optics;
  const bool gathers = node.ray.path.gathers;
  // What stands behind what lets rays through is gathered, too, as far as samples of lights see through it.
  constexpr std::uint32_t kMostBehind = 8;
  const bool is_scattered = node.ray.path.density > 0;
  const bool is_deep = node.ray.generation >= rule.max_depth + (gathers || is_scattered ? kMostBehind : 0);
  Spawner spawner(node, object, !is_deep, spawned);
  const bool is_phong = object.material->model == IlluminationModel::blinn_phong;
  if (gathers && !optics.refracts && !optics.transparent) return;
  const auto bent = [&](SpawnedRay* ray) {
    if (object.turns) note_refraction(ray);
  };
  const auto refracted = [&](SpawnedRay* ray) {
    bent(ray);
    if (ray == nullptr) return;
    ++ray->path.transmission;
    ray->path.gathers = gathers || ray->path.transmission > rule.transmission_depth;
  };
  const CoverageChoice& coverage = node.coverage;
  if (optics.transparent && coverage.goes_on()) bent(add_straight_ray(spawner, node, object, is_deep));
  if (!coverage.sees_surface()) return;
  const VertexTexels texels = texels_of_lobes(node, object);
  const Interface interface(node, object, texels);
  if (!gathers && is_phong && optics.reflects) add_mirror_ray(spawner, node, interface.normal());
  // Where what goes through is blurred, a lobe stands for it, but for rays that only gather.
  const bool is_smooth = gathers || !object.blurs;
  if (is_smooth) interface.refract(spawner, false, refracted);
  if (is_smooth) interface.refract(spawner, true, refracted);
  if (gathers) return;
  const VertexLobes lobes = lobes_at(node, object, interface.normal(), coat_normal(node, object, texels), texels);
  if (!lobes.any()) return;
  add_lobe_ray(spawner, node, object, lobes, rule, optics.refracts ? interface.factor(interface.reflectance()) : 1.0F);
  spawned.lobes = lobes;
}

}  // namespace

void go_straight(const RayNode& node, const RayObject& object, SpawnedRay& ray) {
  ray.origin = node.ray.origin;
  ray.direction = node.ray.direction;
  ray.cone_width = node.ray.cone_width;
  ray.start = node.ray.start;
  ray.end = node.ray.end;
  ray.behind = {node.object, node.hit, node.t, object.key};
  ray.travelled = node.length;
  ray.travelled_slack = distance_slack(node, object);
}

VertexLobes find_lobes(const RayNode& node, const RayObject& object) {
  if (node.ray.path.gathers || !node.coverage.sees_surface()) return {};
  const VertexTexels texels = texels_of_lobes(node, object);
  return lobes_at(node, object, base_normal(node, object, texels), coat_normal(node, object, texels), texels);
}

void spawn(const RayNode& node, const RayObject& object, const SpawnRule& rule, Spawned& spawned) {
  if (rule.integrator == Integrator::path)
    spawn_path(node, object, rule, spawned);
  else
    spawn_whitted(node, object, rule, spawned);
}

}  // namespace relook
