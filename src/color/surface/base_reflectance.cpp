#include "color/surface/base_reflectance.h"

namespace relook {

BaseReflectance::BaseReflectance(SurfaceTerms& terms, const Triple& base, Scalar metallic)
    : t_(terms),
      base_(base),
      metallic_(metallic),
      specular_(terms.textured(Field::specular, Slot::specular, 3)),
      f0_(dielectric_f0()) {
  // The inside of a volume is an interface of its ior alone.
  if (t_.builder().shape(Field::iridescence).iridescent && !t_.key().interface_only) film_ = film();
}

Triple BaseReflectance::dielectric(Scalar weight, Scalar cosine) {
  return filmed(reflectance_between(f0_, Triple{specular_, specular_, specular_}, weight), f0_, cosine);
}

Triple BaseReflectance::mixed(const Triple& dielectric, Scalar weight, Scalar cosine) {
  const Triple metal = filmed(reflectance_between(base_, t_.grey(1), weight), base_, cosine);
  return dielectric * (1.0F - metallic_) + metal * metallic_;
}

Scalar BaseReflectance::entered(const Triple& dielectric) const {
  const Scalar rest = 1.0F - largest(dielectric);
  return film_ ? max(rest, 0.0F) : rest;
}

Triple BaseReflectance::dielectric_f0() {
  const Scalar bare = normal_reflectance(t_.ior(), 1.0F);
  const Triple color = t_.textured3(Field::specular_color, Slot::specular_color) * bare;
  return Triple{min(color.x, 1.0F), min(color.y, 1.0F), min(color.z, 1.0F)} * specular_;
}

ThinFilm<Scalar> BaseReflectance::film() {
  Scalar thickness = t_.field(Field::iridescence_maximum);
  if (t_.has(Slot::iridescence_thickness)) {
    const Scalar least = t_.field(Field::iridescence_minimum);
    thickness = least + (thickness - least) * t_.texel(Slot::iridescence_thickness, 1);
  }
  return {t_.field(Field::iridescence_ior), thickness};
}

Triple BaseReflectance::filmed(const Triple& bare, const Triple& f0, Scalar cosine) {
  if (!film_) return bare;
  const Scalar share = t_.textured(Field::iridescence, Slot::iridescence, 0);
  return bare * (1.0F - share) + film_reflectance(*film_, f0, cosine) * share;
}

}  // namespace relook
