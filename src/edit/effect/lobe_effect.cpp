#include "edit/effect/lobe_effect.h"

#include <algorithm>
#include <cmath>

#include "scene/coverage_bucket.h"
#include "scene/surface_optics.h"

namespace relook {
namespace {

/// First and last bucket of what a surface may have.
struct Buckets {
  int first = 0, last = 0;
  [[nodiscard]] bool is_one() const { return first == last; }
  bool operator==(const Buckets&) const = default;
};

/// Of a factor times a channel of its texture. Lookups mix texels, and may miss their extremes by rounding; those of
/// bytes do not miss 1 where all texels have it.
std::pair<float, float> scaled(float factor, const TextureSlot& slot, int channel) {
  if (slot.kind == TextureKind::none) return {factor, factor};
  constexpr float kRounding = 1e-5F;
  const auto [lowest, highest] = texture_range(slot);
  const float smallest = lowest[channel], largest = highest[channel];
  const bool is_one = slot.kind == TextureKind::image && slot.pyramid->format != TexelFormat::float32 &&
                      smallest == 1 && largest == 1;
  if (is_one) return {factor, factor};
  return {factor * smallest * (1 - kRounding), factor * largest * (1 + kRounding)};
}

/// Of alpha: [2^k, 2^(k+1)) is bucket k.
int alpha_bucket(float roughness) {
  constexpr float kSmoothest = 0.05F;
  const float clamped = std::clamp(roughness, kSmoothest, 1.0F);
  return std::min(std::ilogb(clamped * clamped), -1);  // 1 belongs to the last but one
}
Buckets alpha_buckets(float factor, const TextureSlot& slot) {
  const auto [low, high] = scaled(factor, slot, 1);
  return {alpha_bucket(low), alpha_bucket(high)};
}

/// Of blinn-phong: [2^k, 2^(k+1)) is bucket k, everything below 1 is -1.
int shininess_bucket(float shininess) { return shininess < 1 ? -1 : std::ilogb(shininess); }

int metal_bucket(float metallic) { return metallic < 1.0F / 64 ? 0 : metallic > 63.0F / 64 ? 2 : 1; }
Buckets metal_buckets(const Material& m) {
  const auto [low, high] = scaled(m.metallic, m.slot(Slot::metallic_roughness), 2);
  return {metal_bucket(low), metal_bucket(high)};
}
Buckets roughness_buckets(const Material& m) {
  return alpha_buckets(m.roughness, m.slot(Slot::metallic_roughness));
}
Buckets coat_buckets(const Material& m) {
  return alpha_buckets(m.clearcoat_roughness, m.slot(Slot::clearcoat_roughness));
}

Buckets coverage_buckets(const Material& m, const Mesh& mesh) {
  const auto [low, high] = scaled(m.base_color.a, m.slot(Slot::base_color), 3);
  // Vertex colours are at most 1, and their mixing rounds, too.
  const float least = mesh.colors.empty() ? 1 : mesh.min_alpha * (1 - 1e-5F);
  return {static_cast<int>(bucket_of_coverage(low * least)), static_cast<int>(bucket_of_coverage(high))};
}

bool is_black(const Color& color) { return color == Color(0, 0, 0); }

/// Could hits get another bucket? Not if both have one and the same, nor if nothing that decides it differs.
bool differs(Buckets before, Buckets after, bool is_same_input) {
  return !is_same_input && !(before.is_one() && before == after);
}

/// The same lobes on both? Factors decide, never a texel.
bool has_same_lobes(const Material& a, const Material& b) {
  if (material_lobes(a) != material_lobes(b)) return false;
  const auto agree = [](auto x, auto y) { return (x == 0) == (y == 0); };
  return agree(a.clearcoat, b.clearcoat) && agree(a.specular, b.specular) && agree(a.transmission, b.transmission) &&
         agree(a.iridescence, b.iridescence) && is_black(a.specular_color) == is_black(b.specular_color) &&
         is_black(a.sheen_color) == is_black(b.sheen_color);
}

}  // namespace

bool turns_lobes(const Material& before, const Material& after, std::span<const MaterialRow> rows) {
  if (before.model != after.model) return true;
  if (after.model == IlluminationModel::unlit) return false;
  if (relook::differs(MaterialRow::bends, before, after, rows)) return true;
  if (after.model == IlluminationModel::blinn_phong)
    return shininess_bucket(before.shininess) != shininess_bucket(after.shininess) || before.reflection != after.reflection ||
           before.refraction != after.refraction || before.transparency != after.transparency ||
           material_lobes(before) != material_lobes(after);
  if (!has_same_lobes(before, after) || before.ior != after.ior) return true;
  if (before.anisotropy != after.anisotropy ||
      (after.anisotropy > 0 && (before.anisotropy_rotation != after.anisotropy_rotation ||
                                before.slot(Slot::anisotropy) != after.slot(Slot::anisotropy))))
    return true;
  const bool same_texture = before.slot(Slot::metallic_roughness) == after.slot(Slot::metallic_roughness);
  if (differs(metal_buckets(before), metal_buckets(after), same_texture && before.metallic == after.metallic))
    return true;
  const bool same_roughness = same_texture && before.roughness == after.roughness;
  // A brushed lobe has a bucket along its brush, too.
  if (after.anisotropy > 0 && !same_roughness) return true;
  if (differs(roughness_buckets(before), roughness_buckets(after), same_roughness)) return true;
  if (after.clearcoat == 0) return false;
  const bool same_coat = before.slot(Slot::clearcoat_roughness) == after.slot(Slot::clearcoat_roughness) &&
                         before.clearcoat_roughness == after.clearcoat_roughness;
  return relook::differs(MaterialRow::bends_coat, before, after, rows) ||
         differs(coat_buckets(before), coat_buckets(after), same_coat);
}

bool turns_coverage(const Material& before, const Material& after, const Mesh& mesh) {
  if (!passes_by_coverage(before) || !passes_by_coverage(after))
    return passes_by_coverage(before) != passes_by_coverage(after);
  const bool is_same_input = before.base_color.a == after.base_color.a &&
                             before.slot(Slot::base_color) == after.slot(Slot::base_color);
  return differs(coverage_buckets(before, mesh), coverage_buckets(after, mesh), is_same_input);
}

}  // namespace relook
