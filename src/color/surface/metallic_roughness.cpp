// glTF 2.0 Appendix B with KHR_materials_{ior, specular, transmission, volume, anisotropy, iridescence, clearcoat,
// sheen, emissive_strength, dispersion} as a colour expression: layers upon each other. SHADING.md has the formulas.
#include "color/surface/base_layer.h"
#include "color/surface/coat_layer.h"
#include "color/surface/models.h"
#include "color/surface/sheen_layer.h"

namespace relook {
namespace {

/// For the index of refraction that `terms` takes.
Triple layered_color(SurfaceTerms& terms) {
  BaseLayer base(terms);
  Triple sum = base.view_terms();
  if (terms.key().interface_only) return sum;
  const auto add_lamps = [&](auto& layer) {
    sum = terms.with_lamps(sum, [&](const Triple& direction) { return layer.reflected(direction); });
  };
  add_lamps(base);
  if (terms.builder().shape(Field::sheen_color).sheen) {
    SheenLayer sheen(terms, base.normal(), base.nv());
    sum = sum * sheen.passed();
    add_lamps(sheen);
  }
  if (terms.counts(kEmissionSource)) sum = sum + terms.emission();
  if (terms.builder().shape(Field::clearcoat).clearcoat) {
    CoatLayer coat(terms);
    sum = sum * coat.passed();
    add_lamps(coat);
    if (terms.has_child(Branch::coat)) sum = sum + coat.mirror();
  }
  return sum;
}

/// Does the material have an index of refraction for each channel?
bool has_indices(SurfaceTerms& terms) {
  ExpressionBuilder& b = terms.builder();
  return b.shape(Field::dispersion).disperses && b.shape(Field::thickness).thick &&
         b.shape(Field::transmission).transmits;
}

}  // namespace

Triple metallic_roughness_color(SurfaceTerms& terms) {
  if (!has_indices(terms)) return layered_color(terms);
  const auto in = [&](Channel channel) {
    terms.take(channel);
    return layered_color(terms);
  };
  const Triple red = in(Channel::red), green = in(Channel::green), blue = in(Channel::blue);
  return {red.x, green.y, blue.z};
}

}  // namespace relook
