// Transparent surfaces between a node and a light: SHADING.md, "Tint".
#include "color/surface/models.h"

namespace relook {

Triple filter_color(SurfaceTerms& terms) {
  Triple through = terms.grey(0);
  const IlluminationModel model = terms.builder().shape(Field::model).model;
  if (model == IlluminationModel::blinn_phong) {
    through = terms.base_color() * min(terms.field(Field::refraction) + terms.field(Field::transparency), 1.0F);
  } else if (model == IlluminationModel::metallic_roughness) {
    const Scalar share = terms.textured(Field::transmission, Slot::transmission, 0) *
                         (1.0F - terms.textured(Field::metallic, Slot::metallic_roughness, 2));
    through = {share, share, share};
    const bool leaves_volume = terms.key().inside && terms.builder().shape(Field::thickness).thick;
    through = through * (leaves_volume ? terms.beer(terms.input(Input::length_inside)) : terms.base_color());
  }
  if (terms.builder().shape(Field::alpha_mode).alpha_mode != AlphaMode::blend) return through;
  const Scalar coverage = terms.coverage();
  const Scalar rest = 1.0F - coverage;
  return through * coverage + Triple{rest, rest, rest};
}

}  // namespace relook
