#include "color/surface/illumination.h"

#include <numbers>

#include "color/surface/surface_terms.h"

namespace relook {

Triple blinn_phong_color(SurfaceTerms& terms) {
  constexpr float kInversePi = std::numbers::inv_pi_v<float>;
  const Triple base = terms.base_color();
  const Triple normal = terms.normal(Slot::normal, Field::normal_scale);
  const Triple diffuse = base * terms.field3(Field::phong_diffuse) * terms.number(kInversePi);
  const Scalar shininess = terms.field(Field::shininess);
  const Triple specular = terms.field3(Field::phong_specular) * ((shininess + 8.0F) * (0.125F * kInversePi));
  Triple sum = terms.counts(kAmbientSource)
                   ? terms.ambient() * terms.field3(Field::phong_ambient) * base * terms.occlusion()
                   : terms.grey(0);
  for (const VisibleLight& light : terms.key().lights) {
    const Incidence lamp = terms.incidence(light);
    const Scalar nl = max(dot(normal, lamp.direction), 0.0F);
    const Scalar nh = max(dot(normal, normalized(lamp.direction + terms.view())), 1e-7F);
    const Scalar lobe = exp2(log2(min(nh, 1.0F)) * shininess);
    sum = terms.with(light, sum, (diffuse + specular * lobe) * nl * lamp.irradiance);
  }
  if (terms.counts(kEmissionSource)) sum = sum + terms.emission();
  if (terms.has_child(Branch::reflection)) sum = sum + terms.child(Branch::reflection) * terms.field(Field::reflection);
  if (terms.has_child(Branch::refraction)) sum = sum + terms.child(Branch::refraction) * terms.field(Field::refraction);
  if (terms.has_child(Branch::transparency))
    sum = sum + terms.child(Branch::transparency) * terms.field(Field::transparency);
  return sum;
}

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

/// The share of light that passes a transparent surface on its way to a node.
std::array<Value, 4> filter_expression(SurfaceTerms& terms) {
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
  if (terms.builder().shape(Field::alpha_mode).alpha_mode != AlphaMode::blend) return values(through, terms.number(1));
  const Scalar coverage = terms.coverage();
  const Scalar rest = 1.0F - coverage;
  return values(through * coverage + Triple{rest, rest, rest}, terms.number(1));
}

std::array<Value, 4> environment_expression(SurfaceTerms& terms) {
  if (terms.key().aspect != Aspect::color || !terms.counts(kEnvironmentSource))
    return values(terms.grey(0), terms.number(0));
  ExpressionBuilder& b = terms.builder();
  Triple color{{&b, b.environment(0)}, {&b, b.environment(1)}, {&b, b.environment(2)}};
  if (b.scene().environment.image) {
    const Triple direction = terms.view() * terms.number(-1);
    const Value lookup = b.environment_map(direction.x.value, direction.y.value, direction.z.value);
    color = color * Triple{{&b, lookup}, {&b, b.channel(lookup, 1)}, {&b, b.channel(lookup, 2)}};
  }
  return values(color, terms.number(0));
}

}  // namespace

NodeKey restricted(NodeKey key, const ColorPart& part) {
  key.aspect = part.aspect;
  key.sources &= part.sources;
  key.children = key.children & part.branches;
  if (!part.all_lamps) std::erase_if(key.lights, [&](const VisibleLight& light) { return light.light != part.lamp; });
  return key;
}

std::vector<VisibleLight> asked_lights(std::span<const LightId> order) {
  std::vector<VisibleLight> lights;
  lights.reserve(order.size());
  for (std::uint32_t place = 0; place < order.size(); ++place) lights.push_back({order[place], place, true, true});
  return lights;
}

ColorProgram build_program(const Scene& scene, const MaterialStructure& structure, const NodeKey& key) {
  ExpressionBuilder builder(scene, structure);
  SurfaceTerms terms(builder, key);
  std::array<Value, 4> result{};
  switch (key.kind) {
    case NodeKind::surface:
      result = key.aspect == Aspect::color ? surface_expression(terms) : aspect_expression(terms);
      break;
    case NodeKind::filter:
      result = filter_expression(terms);
      break;
    case NodeKind::environment:
      result = environment_expression(terms);
      break;
  }
  return finish(builder, result);
}

}  // namespace relook
