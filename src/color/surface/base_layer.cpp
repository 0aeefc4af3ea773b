#include "color/surface/base_layer.h"

#include "physics/fresnel.h"
#include "physics/lobe_angles.h"
#include "physics/mirror.h"
#include "scene/surface_optics.h"

namespace relook {

BaseLayer::BaseLayer(SurfaceTerms& terms)
    : t_(terms),
      base_(terms.base_color()),
      metallic_(terms.textured(Field::metallic, Slot::metallic_roughness, 2)),
      normal_(terms.normal(Slot::normal, Field::normal_scale)),
      view_(terms.view()),
      nv_(max(dot(normal_, view_), kLeastCosine)),
      specular_(terms, terms.textured(Field::roughness, Slot::metallic_roughness, 1)),
      diffuse_{base_, metallic_, transmission()},
      reflectance_(terms, base_, metallic_) {}

Triple BaseLayer::reflected(const Triple& direction) {
  const LobeAngles<Triple> at = lobe_angles(normal_, view_, direction);
  const Scalar weight = schlick(at.vh);
  const Triple dielectric = reflectance_.dielectric(weight, at.vh);
  const Triple diffuse = diffuse_.value(reflectance_.entered(dielectric));
  const Scalar lobe = specular_.value(at, direction, view_, nv_);
  const Triple specular = reflectance_.mixed(dielectric, weight, at.vh) * lobe;
  return (diffuse + specular) * at.nl;
}

Triple BaseLayer::view_terms() {
  const bool volume = t_.builder().shape(Field::thickness).thick && may_transmit();
  const Scalar weight = volume ? exact_weight(t_.ior(), t_.key().inside, interface_cosine()) : schlick(nv_);
  const Triple dielectric = reflectance_.dielectric(weight, nv_);
  const Triple mirror = reflectance_.mixed(dielectric, weight, nv_);
  const auto entered = [&] { return reflectance_.entered(dielectric); };
  const Scalar fade = mirror_fade(specular_.mirror_roughness(), kMirrorThreshold);
  Triple sum = t_.grey(0);
  if (!t_.key().interface_only && t_.counts(kAmbientSource))
    sum = t_.ambient() * t_.occlusion() * (diffuse_.albedo(entered()) + mirror * (1.0F - fade));
  if (t_.has_child(Branch::reflection)) {
    Triple seen = t_.child(Branch::reflection) * mirror * fade;
    if (volume && t_.key().inside) seen = seen * t_.beer(child_length(Branch::reflection));
    sum = sum + seen;
  }
  if (t_.has_child(t_.refraction())) {
    const Scalar share = (1.0F - metallic_) * diffuse_.transmission * entered();
    Triple seen = t_.child(t_.refraction()) * share;
    if (!volume || !t_.key().inside) seen = seen * base_;  // a volume tints once, where it is entered
    if (volume && !t_.key().inside) seen = seen * t_.beer(child_length(t_.refraction()));
    sum = sum + seen;
  }
  return sum;
}

}  // namespace relook
