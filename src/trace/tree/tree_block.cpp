#include "trace/tree/tree_block.h"

#include <cmath>

#include "physics/dispersion.h"
#include "physics/fresnel.h"
#include "physics/mirror.h"
#include "trace/tree/path_cursor.h"

namespace relook {
namespace {

constexpr float kFresnelCut = 1e-3F;

/// Of a coat, at a cosine of at most 1. Its weight is Schlick's but for the order of the products.
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
    const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(branch));
    const float product = node_.ray.fresnel_product * fresnel;
    if (product < kFresnelCut) {
      spawned_.cut_mask |= bit;
      return nullptr;
    }
    SpawnedRay& ray = spawned_.rays[static_cast<std::size_t>(branch)];
    ray.cone_spread = node_.ray.cone_spread;
    ray.fresnel_product = product;
    ray.generation = static_cast<std::uint8_t>(node_.ray.generation + 1);
    ray.branch = branch;
    ray.channel = channel_of(branch, node_.ray.channel);
    spawned_.mask |= bit;
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
  const float cosine = std::fmax(-d.dot(n), 1e-4F);
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
  const float counted = optics.dielectric_cut ? 1.0F : 0.0F;
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
                coat_term(std::fmin(std::fmax(-d.dot(coat), 1e-4F), 1.0F)));
  }
  const auto refract = [&](Branch branch, float eta, float passed) {
    if (!optics.bent) return spawner.add_straight(branch, passed);
    const auto sin2_behind = [&](float c) { return (1.0F - c * c) / (eta * eta); };
    const bool is_flat = flat_cosine > cosine && sin2_behind(std::fmin(cosine, 1.0F)) >= 1.0F;
    const float c = std::fmin(is_flat ? flat_cosine : cosine, 1.0F);
    const float sin2 = sin2_behind(c);
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

void complete(RayNode& node, const RayObject& object) {
  node.point = surface_point(object, node.hit, node.ray.direction);
  const Direction way = node.point.position - node.ray.origin;
  node.length = std::sqrt(way.dot(way));
  const float width = node.ray.cone_width + node.ray.cone_spread * node.length;
  node.footprint = width / std::fmax(-node.ray.direction.dot(node.point.geometric), 0.05F);
}

float distance_slack(const RayNode& node, const RayObject& object) {
  constexpr float kUlps = 0x1p-17F;  // 128 units in the last place
  const Point& o = node.ray.origin;
  const float coordinates = std::fabs(o.x) + std::fabs(o.y) + std::fabs(o.z);
  const float cosine = std::fmax(-node.ray.direction.dot(node.point.geometric), 1e-4F);
  // On long thin triangles rounded barycentrics move the point along the triangle: it lies that far beside the ray.
  const Direction way = node.point.position - o;
  const Direction beside = way - node.ray.direction * way.dot(node.ray.direction);
  const float known = (kUlps * (node.length + coordinates) + 8 * node.point.offset) * object.condition;
  return (known + 2 * std::sqrt(beside.dot(beside))) / cosine;
}

ShadowSegment shadow_segment(const SurfacePoint& point, const Light& light) {
  ShadowSegment segment;
  const bool directional = light.kind == LightKind::directional;
  const Direction to_light = directional ? -light.direction : light.position - point.position;
  segment.faces = point.shading.dot(to_light) > 0;
  // A light near the horizon of the triangle is judged from the smooth surface.
  constexpr float kHorizon = 0.1F;  // cosine
  const float height = point.geometric.dot(to_light) / std::sqrt(to_light.dot(to_light));
  const float share = std::fmin(std::fmax(1.0F - height / kHorizon, 0.0F), 1.0F);
  segment.origin = point.position + point.lift * share + point.geometric * point.offset;
  segment.direction = directional ? to_light : light.position - segment.origin;
  segment.t_max = directional ? std::numeric_limits<float>::infinity() : 1.0F;
  return segment;
}

void complete_filters(const RayScene& scene, const RayNode& node, const ShadowSegment& segment, FilterNode* filters,
                      std::size_t count) {
  const Direction way = unit(segment.direction);
  for (std::size_t i = 0; i < count; ++i) {
    FilterNode& filter = filters[i];
    const RayObject& object = scene.object(filter.object);
    filter.point = surface_point(object, filter.hit, way);
    filter.footprint = node.footprint;  // no finer than what is shaded
    filter.length_inside = 0;
    if (!object.optics.volume || !filter.point.inside) continue;
    Point entry = segment.origin;
    for (std::size_t j = i; j-- > 0;) {
      if (filters[j].object != filter.object) continue;
      entry = filters[j].point.position;
      break;
    }
    const Direction inside = filter.point.position - entry;
    filter.length_inside = std::sqrt(inside.dot(inside));
  }
}

std::span<const std::uint32_t> TreeBlock::blocker_entry(const LightLink& link) const {
  const std::uint32_t* entry = blocker_words.data() + link.first;
  return {entry, entry_size(entry[0], ShadowState::blocked)};
}

void pack(const TreeBlock& block, std::uint32_t root, const PathLayout& layout, std::vector<std::uint32_t>& words,
          std::vector<Hit>& hits) {
  const std::uint32_t sample = block.nodes[root].sample;
  for (std::size_t i = root; i < block.nodes.size() && block.nodes[i].sample == sample; ++i) {
    const RayNode& node = block.nodes[i];
    if (node.object.is_none()) {
      words.push_back(PathTable::kMissWord);
      continue;
    }
    std::uint8_t branches = 0;
    for (std::size_t b = 0; b < kBranches; ++b)
      if (node.child[b] != kNoNode) branches = static_cast<std::uint8_t>(branches | 1U << b);
    const std::uint32_t flags = branch_flags(branches) | (node.point.inside ? kInsideFlag : 0U) |
                                static_cast<std::uint32_t>(node.cut_mask) << kCutShift;
    words.push_back(node.object.index());
    words.push_back(flags);
    hits.push_back(node.hit);
    const std::size_t states = words.size();
    words.resize(states + (layout.lights + 15) / 16);
    for (std::size_t light = 0; light < layout.lights; ++light) {
      const LightLink& link = block.lights[node.first_light + light];
      words[states + light / 16] |= static_cast<std::uint32_t>(link.state) << (2 * (light % 16));
      if (!has_entry(link.state, layout.shadow_bits)) continue;
      if (link.state == ShadowState::blocked) {
        const auto entry = block.blocker_entry(link);
        words.insert(words.end(), entry.begin(), entry.end());
        continue;
      }
      words.push_back(link.filters);
      for (std::uint32_t f = 0; f < link.filters; ++f) {
        const FilterNode& filter = block.filters[link.first + f];
        words.push_back(filter.object.index());
        hits.push_back(filter.hit);
      }
    }
  }
}

}  // namespace relook
