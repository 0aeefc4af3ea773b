#include "color/surface/illumination.h"

#include "color/surface/models.h"

namespace relook {
namespace {

std::array<Value, 4> values(const Triple& color, Scalar alpha) {
  return {color.x.value, color.y.value, color.z.value, alpha.value};
}

std::array<Value, 4> surface_expression(SurfaceTerms& terms) {
  const IlluminationModel model = terms.builder().shape(Field::model).model;
  Triple color = model == IlluminationModel::metallic_roughness ? metallic_roughness_color(terms)
                 : model == IlluminationModel::blinn_phong      ? blinn_phong_color(terms)
                 : terms.counts(kEmissionSource)                ? terms.base_color()
                                                                : terms.grey(0);
  if (terms.builder().shape(Field::alpha_mode).alpha_mode != AlphaMode::blend) return values(color, terms.number(1));
  const Scalar coverage = terms.coverage();
  color = color * coverage;
  if (!terms.has_child(Branch::transparency)) return values(color, coverage);
  const Scalar rest = 1.0F - coverage;
  return values(color + terms.child(Branch::transparency) * rest,
                coverage + rest * terms.child_alpha(Branch::transparency));
}

std::array<Value, 4> aspect_expression(SurfaceTerms& terms) {
  if (terms.key().aspect == Aspect::normal)
    return values(terms.normal(Slot::normal, Field::normal_scale), terms.number(1));
  return values(terms.base_color(), terms.coverage());
}

}  // namespace

ColorProgram build_program(const Scene& scene, const MaterialStructure& structure, const NodeKey& key) {
  ExpressionBuilder builder(scene, structure);
  SurfaceTerms terms(builder, key);
  std::array<Value, 4> result{};
  switch (key.kind) {
    case NodeKind::surface:
      result = key.aspect == Aspect::color ? surface_expression(terms) : aspect_expression(terms);
      break;
    case NodeKind::filter:
      result = values(filter_color(terms), terms.number(1));
      break;
    case NodeKind::environment:
      result = values(environment_color(terms), terms.number(0));
      break;
  }
  return finish(builder, result);
}

}  // namespace relook
