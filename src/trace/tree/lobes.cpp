#include "trace/tree/lobes.h"

#include "physics/brushed_ggx.h"
#include "physics/fresnel.h"
#include "physics/ggx.h"
#include "trace/tree/tree_block.h"

namespace relook {
namespace {

/// A factor times a channel of its texture.
float textured(const RayNode& node, const RayObject& object, float factor, Slot slot, int channel) {
  const TextureSlot& texture = object.material->slot(slot);
  if (texture.kind == TextureKind::none) return factor;
  return factor *
         texture_value(texture, texture_coordinates(object, node.hit, node.point.local, texture), node.footprint)[channel];
}

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
  const Rgba texel =
      texture_value(texture, texture_coordinates(object, node.hit, node.point.local, texture), node.footprint);
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

}  // namespace

LobeSet lobe_set(const Material& material, const SurfaceOptics& optics, bool inside) {
  const MaterialLobes lobes = material_lobes(material);
  if (optics.volume && inside) return {false, lobes.specular, false};
  return {lobes.diffuse, lobes.specular, lobes.coat && !inside};
}

VertexLobes lobes_at(const RayNode& node, const RayObject& object, const Normal& normal, const Normal& coat_normal) {
  VertexLobes lobes;
  const Material& material = *object.material;
  const LobeSet set = lobe_set(material, object.optics, node.point.inside);
  if (!set.diffuse && !set.specular && !set.coat) return lobes;
  const Direction view = -node.ray.direction;
  lobes.base = basis_about(normal);
  lobes.view = lobes.base.to_local(view);
  const float cosine = std::fmin(std::fmax(lobes.view.z, kLeastCosine), 1.0F), floor = node.ray.path.alpha_floor;
  float coat = 0;
  if (set.coat) {
    lobes.coat_base = basis_about(coat_normal);
    lobes.coat_view = lobes.coat_base.to_local(view);
    coat = coat_reflectance(schlick(std::fmax(lobes.coat_view.z, kLeastCosine)));
    set_glossy(textured(node, object, material.clearcoat_roughness, Slot::clearcoat_roughness, 1), floor,
               lobes.coat_bucket, lobes.coat);
  }
  if (set.specular) {
    const float roughness = textured(node, object, material.roughness, Slot::metallic_roughness, 1);
    set_glossy(roughness, floor, lobes.specular_bucket, lobes.specular);
    const Brush brush = brush_at(node, object);
    if (brush.along.dot(brush.along) > 0) {
      const float along = widened(alpha_of(floored(roughness, floor)), brush.strength * brush.strength);
      lobes.specular.alpha_x = bucket_of_alpha(along).representative();
      lobes.base = basis_along(normal, brush.along);
      lobes.view = lobes.base.to_local(view);
    }
  }
  const MetallicBucket metallic = bucket_of_metallic(textured(node, object, material.metallic, Slot::metallic_roughness, 2));
  const float ior = std::fmax(material.ior, 1.0F);
  const float reflectance = dielectric_reflectance(cosine, node.point.inside && object.optics.bent ? 1 / ior : ior);
  lobes.shares = lobe_shares(set, metallic, reflectance, coat);
  return lobes;
}

float VertexLobes::density(Lobe lobe, const Direction& way) const {
  const float share = shares.of(lobe);
  if (!(share > 0)) return 0;
  if (lobe == Lobe::coat) {
    const Direction local = coat_base.to_local(way);
    return local.z > 0 ? share * coat.density(coat_view, local) : 0.0F;
  }
  const Direction local = base.to_local(way);
  if (!(local.z > 0)) return 0;
  return share * (lobe == Lobe::diffuse ? cosine_density(local.z) : specular.density(view, local));
}

std::optional<LobeSample> sample_lobe(const VertexLobes& lobes, const Normal& geometric, Uv u) {
  const LobeChoice choice = chosen_lobe(lobes.shares, u.x);
  const Uv rest(choice.u, u.y);
  Direction way;
  if (choice.lobe == Lobe::diffuse) {
    way = lobes.base.to_world(cosine_direction(rest));
  } else {
    const bool is_coat = choice.lobe == Lobe::coat;
    const auto local = is_coat ? lobes.coat.sample(lobes.coat_view, rest) : lobes.specular.sample(lobes.view, rest);
    if (!local) return std::nullopt;
    way = (is_coat ? lobes.coat_base : lobes.base).to_world(*local);
  }
  way = way / std::sqrt(way.dot(way));
  const float density = lobes.density(choice.lobe, way);
  if (!(way.dot(geometric) > 0) || !(density > 0)) return std::nullopt;
  return LobeSample{choice.lobe, way, density};
}

}  // namespace relook
