#include "color/surface/specular_lobe.h"

#include "physics/ggx.h"

namespace relook {

SpecularLobe::SpecularLobe(SurfaceTerms& terms, Scalar roughness)
    : roughness_(roughness), alpha2_(square(alpha_of(roughness))) {
  if (!terms.builder().shape(Field::anisotropy).anisotropic) return;
  const auto [tangent, bitangent] = terms.axes(Slot::anisotropy);
  const Scalar cosine = terms.field(Field::anisotropy_rotation, 0);
  const Scalar sine = terms.field(Field::anisotropy_rotation, 1);
  Scalar x = cosine, y = sine;
  if (terms.has(Slot::anisotropy)) {
    const Scalar u = terms.texel(Slot::anisotropy, 0) * 2.0F - 1.0F;
    const Scalar v = terms.texel(Slot::anisotropy, 1) * 2.0F - 1.0F;
    const Scalar scale = 1.0F / sqrt(max(u * u + v * v, 1e-30F));
    x = (cosine * u - sine * v) * scale;
    y = (sine * u + cosine * v) * scale;
  }
  const BrushAxes<Triple> axes = brush_axes(tangent, bitangent, x, y);
  const Scalar strength = terms.textured(Field::anisotropy, Slot::anisotropy, 2);
  brush_ = {axes, dot(axes.along, axes.along), square(strength)};
}

Scalar SpecularLobe::value(const LobeAngles<Triple>& at, const Triple& direction, const Triple& view, Scalar nv) const {
  return brushed_or(ggx(alpha2_, at.nh, at.nl, nv), at, direction, view, nv);
}

Scalar SpecularLobe::precise_value(const LobeAngles<Triple>& at, const Triple& normal, const Triple& direction,
                                   const Triple& view, Scalar nv) const {
  return brushed_or(precise_ggx(alpha2_, at.nh, half_sine2(normal, at), at.nl, nv), at, direction, view, nv);
}

Scalar SpecularLobe::brushed_or(Scalar isotropic, const LobeAngles<Triple>& at, const Triple& direction,
                                const Triple& view, Scalar nv) const {
  if (!brush_) return isotropic;
  const Scalar alpha = alpha_of(roughness_);
  const auto seen = [&](const Triple& way, Scalar up) {
    return Brushed<Scalar>{dot(brush_->axes.along, way), dot(brush_->axes.across, way), up};
  };
  const Scalar brushed = brushed_ggx(widened(alpha, brush_->strength2), alpha, seen(at.half, at.nh),
                                     seen(direction, at.nl), seen(view, nv));
  return if_positive(brush_->is_there, brushed, isotropic);
}

Scalar SpecularLobe::mirror_roughness() const {
  if (!brush_) return roughness_;
  return if_positive(brush_->is_there, sqrt(widened(roughness_ * roughness_, brush_->strength2)), roughness_);
}

}  // namespace relook
