#include "color/surface/coat_layer.h"

#include "physics/fresnel.h"
#include "physics/ggx.h"
#include "physics/lobe_angles.h"
#include "physics/mirror.h"
#include "scene/surface_optics.h"

namespace relook {

CoatLayer::CoatLayer(SurfaceTerms& terms)
    : t_(terms),
      strength_(terms.textured(Field::clearcoat, Slot::clearcoat, 0)),
      roughness_(terms.textured(Field::clearcoat_roughness, Slot::clearcoat_roughness, 1)),
      normal_(terms.normal(Slot::clearcoat_normal, Field::clearcoat_normal_scale)),
      view_(terms.view()),
      nv_(max(dot(normal_, view_), kLeastCosine)),
      fresnel_(coat_reflectance(schlick(nv_))) {}

Triple CoatLayer::reflected(const Triple& direction) {
  const LobeAngles<Triple> at = lobe_angles(normal_, view_, direction);
  const Scalar lobe = ggx(square(alpha_of(roughness_)), at.nh, at.nl, nv_) * coat_reflectance(schlick(at.vh));
  const Scalar value = strength_ * lobe * at.nl;
  return {value, value, value};
}

Scalar CoatLayer::passed() { return 1.0F - strength_ * fresnel_; }

Triple CoatLayer::mirror() {
  return t_.child(Branch::coat) * (strength_ * fresnel_ * mirror_fade(roughness_, kMirrorThreshold));
}

}  // namespace relook
