#include "trace/tree/lobes.h"

#include "light/point_set.h"
#include "physics/brushed_ggx.h"
#include "physics/dispersion.h"
#include "physics/fresnel.h"
#include "physics/ggx.h"
#include "physics/phong_sample.h"
#include "physics/rough_refraction.h"
#include "trace/tree/tree_block.h"
#include "trace/vertex_texels.h"

namespace relook {
namespace {

/// The direction of a brush, and how much wider the lobe is along it. Zero where the mesh gives none.
struct Brush {
  Direction along{0, 0, 0};
  float strength = 0;
};
Brush brush_at(const RayNode& node, const RayObject& object) {
  const Material& material = *object.material;
  if (material.anisotropy == 0) return {};
  const TextureSlot& texture = material.slot(Slot::anisotropy);
  const TangentFrame frame = tangent_frame(object, node.hit, node.point, texture);
  const float turns = material.anisotropy_rotation * 0.15915494F;
  const float cosine = portable_cos_turns(turns), sine = portable_sin_turns(turns);
  if (texture.kind == TextureKind::none)
    return {brush_axes(frame.tangent, frame.bitangent, cosine, sine).along, material.anisotropy};
  const Rgba texel = texel_at(node, object, texture);
  const float u = texel.r * 2 - 1, v = texel.g * 2 - 1, scale = 1 / std::sqrt(std::fmax(u * u + v * v, 1e-30F));
  return {brush_axes(frame.tangent, frame.bitangent, (cosine * u - sine * v) * scale, (sine * u + cosine * v) * scale)
              .along,
          material.anisotropy * texel.b};
}

/// The bucket of a roughness and its lobe.
void set_glossy(float roughness, float floor, AlphaBucket& bucket, GlossyLobe& lobe) {
  bucket = bucket_of_alpha(alpha_of(floored(roughness, floor)));
  lobe = {bucket.representative(), bucket.representative()};
}

/// What is let through is as rough as the material says, whatever scattered before.
void set_transmission(const RayNode& node, const RayObject& object, float roughness, VertexLobes& lobes) {
  set_glossy(roughness, 0, lobes.transmission_bucket, lobes.transmission);
  if (!object.optics.bent) return;
  lobes.channel = node.ray.channel;
  if (object.optics.dispersion > 0 && lobes.channel == Channel::all) {
    const float number = sample_number(node.ray.path.key, node.ray.path.history, Purpose::lobe);
    lobes.channel = kChannels[number < 1.0F / 3 ? 0 : number < 2.0F / 3 ? 1 : 2];
    lobes.is_channel_chosen = true;
  }
  const float ior = channel_ior(object.optics, lobes.channel);
  lobes.eta = node.point.inside ? 1.0F / ior : ior;
}

}  // namespace

LobeSet lobe_set(const RayObject& object, bool inside) {
  const MaterialLobes lobes = material_lobes(*object.material);
  if (object.optics.volume && inside) return {false, lobes.specular, false, object.blurs};
  return {lobes.diffuse, lobes.specular, lobes.coat && !inside, object.blurs};
}

float channel_ior(const SurfaceOptics& optics, Channel channel) {
  if (channel == Channel::red) return red_ior(optics.ior, optics.dispersion);
  return channel == Channel::blue ? blue_ior(optics.ior, optics.dispersion) : optics.ior;
}

VertexLobes lobes_at(const RayNode& node, const RayObject& object, const Normal& normal, const Normal& coat_normal,
                     const VertexTexels& texels) {
  VertexLobes lobes;
  const Material& material = *object.material;
  const LobeSet set = lobe_set(object, node.point.inside);
  if (!set.any()) return lobes;
  const Direction view = -node.ray.direction;
  lobes.base = basis_about(normal);
  lobes.view = lobes.base.to_local(view);
  const float cosine = std::fmin(std::fmax(lobes.view.z, kLeastCosine), 1.0F), floor = node.ray.path.alpha_floor;
  if (material.model == IlluminationModel::blinn_phong) {
    const ShininessBucket bucket = bucket_of_shininess(floored_shininess(material.shininess, floor));
    lobes.shininess = bucket.representative();
    lobes.coat_bucket = bucket.as_alpha();
    lobes.shares = power_shares(set);
    return lobes;
  }
  lobes.diffuse.has_sheen = material.sheen_color != Color(0, 0, 0);
  float coat = 0;
  if (set.coat) {
    lobes.coat_base = basis_about(coat_normal);
    lobes.coat_view = lobes.coat_base.to_local(view);
    coat = coat_reflectance(schlick(std::fmax(lobes.coat_view.z, kLeastCosine)));
    const Rgba texel = texels.at(Slot::clearcoat_roughness);
    set_glossy(material.clearcoat_roughness * texel.g, floor, lobes.coat_bucket, lobes.coat);
  }
  const Rgba texel = texels.at(Slot::metallic_roughness);
  const float roughness = material.roughness * texel.g;
  if (set.transmission) set_transmission(node, object, roughness, lobes);
  if (set.specular) {
    set_glossy(roughness, floor, lobes.specular_bucket, lobes.specular);
    const Brush brush = brush_at(node, object);
    if (brush.along.dot(brush.along) > 0) {
      const float along = widened(alpha_of(floored(roughness, floor)), brush.strength * brush.strength);
      lobes.specular.alpha_x = bucket_of_alpha(along).representative();
      lobes.base = basis_along(normal, brush.along);
      lobes.view = lobes.base.to_local(view);
    }
  }
  const MetallicBucket metallic = bucket_of_metallic(material.metallic * texel.b);
  const float ior = std::fmax(material.ior, 1.0F);
  const float reflectance = dielectric_reflectance(cosine, node.point.inside && object.optics.bent ? 1 / ior : ior);
  lobes.shares = lobe_shares(set, metallic, reflectance, coat);
  return lobes;
}

float VertexLobes::density(Lobe lobe, const Direction& way) const {
  const float share = shares.of(lobe);
  if (!(share > 0)) return 0;
  if (lobe == Lobe::coat && shininess < 0) {
    const Direction local = coat_base.to_local(way);
    return local.z > 0 ? share * coat.density(coat_view, local) : 0.0F;
  }
  const Direction local = base.to_local(way);
  if (lobe == Lobe::transmission) return share * transmitted_density(local);
  if (!(local.z > 0)) return 0;
  if (lobe == Lobe::diffuse) return share * diffuse.density(local.z);
  return share * (lobe == Lobe::coat ? phong_reflection_density(shininess, facing(view), local)
                                     : specular.density(view, local));
}

float VertexLobes::transmitted_density(const Direction& way) const {
  if (!(way.z < 0)) return 0;
  if (eta == 0) return transmission.density(view, {way.x, way.y, -way.z});
  const float density = ggx_refraction_density(transmission.alpha_x, facing(view), way, eta);
  return is_channel_chosen ? density * (1.0F / 3) : density;
}

std::optional<Direction> VertexLobes::transmitted(Uv u) const {
  if (eta != 0) {
    const Direction seen = facing(view);
    return refracted_direction(seen, visible_normal(transmission.alpha_x, transmission.alpha_y, seen, u), eta);
  }
  auto way = transmission.sample(view, u);
  if (way) way->z = -way->z;
  return way;
}

std::optional<Direction> VertexLobes::direction(Lobe lobe, Uv u) const {
  switch (lobe) {
    case Lobe::diffuse:
      return diffuse.sample(u);
    case Lobe::specular:
      return specular.sample(view, u);
    case Lobe::transmission:
      return transmitted(u);
    case Lobe::coat:
      break;
  }
  if (shininess < 0) return coat.sample(coat_view, u);
  const Direction seen = facing(view);
  return reflected_direction(seen, phong_half(shininess, u));
}

std::optional<LobeSample> sample_lobe(const VertexLobes& lobes, const Normal& geometric, Uv u) {
  const LobeChoice choice = chosen_lobe(lobes.shares, u.x);
  const auto local = lobes.direction(choice.lobe, {choice.u, u.y});
  if (!local) return std::nullopt;
  const bool is_on_coat = choice.lobe == Lobe::coat && lobes.shininess < 0;
  Direction way = (is_on_coat ? lobes.coat_base : lobes.base).to_world(*local);
  way = way / std::sqrt(way.dot(way));
  const float density = lobes.density(choice.lobe, way);
  const float height = way.dot(geometric);
  const bool leaves = choice.lobe == Lobe::transmission ? height < 0 : height > 0;
  if (!leaves || !(density > 0)) return std::nullopt;
  return LobeSample{choice.lobe, way, density};
}

}  // namespace relook
