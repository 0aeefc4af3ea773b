// The blinn-phong model of SHADING.md: a diffuse lobe and Blinn and Phong's (physics/phong.h), ambient light, emission,
// and child rays in the material's proportions.
#include "color/surface/models.h"
#include "physics/lambert.h"
#include "physics/phong.h"

namespace relook {

Triple blinn_phong_color(SurfaceTerms& terms) {
  const Triple base = terms.base_color();
  const Triple normal = terms.normal(Slot::normal, Field::normal_scale);
  const Triple diffuse = lambert(base * terms.field3(Field::phong_diffuse));
  const Scalar shininess = terms.field(Field::shininess);
  const Triple specular = terms.field3(Field::phong_specular) * phong_scale(shininess);
  Triple sum = terms.counts(kAmbientSource)
                   ? terms.ambient() * terms.field3(Field::phong_ambient) * base * terms.occlusion()
                   : terms.grey(0);
  sum = terms.with_lamps(sum, [&](const Triple& direction) {
    const Scalar nl = max(dot(normal, direction), 0.0F);
    const Scalar nh = max(dot(normal, normalized(direction + terms.view())), 1e-7F);
    const Scalar lobe = phong_lobe(shininess, nh);
    return (diffuse + specular * lobe) * nl;
  });
  if (terms.counts(kEmissionSource)) sum = sum + terms.emission();
  if (terms.has_child(Branch::reflection)) sum = sum + terms.child(Branch::reflection) * terms.field(Field::reflection);
  if (terms.has_child(Branch::refraction)) sum = sum + terms.child(Branch::refraction) * terms.field(Field::refraction);
  if (terms.has_child(Branch::transparency))
    sum = sum + terms.child(Branch::transparency) * terms.field(Field::transparency);
  return sum;
}

}  // namespace relook
