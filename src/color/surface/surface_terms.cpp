#include "color/surface/surface_terms.h"

#include "physics/dispersion.h"

namespace relook {

Scalar SurfaceTerms::textured(Field f, Slot slot, unsigned channel) {
  const Scalar factor = field(f);
  return has(slot) ? factor * texel(slot, channel) : factor;
}

Triple SurfaceTerms::textured3(Field f, Slot slot) {
  const Triple factor = field3(f);
  return has(slot) ? factor * texel3(slot) : factor;
}

Triple SurfaceTerms::base_color() {
  const Triple color = textured3(Field::base_color, Slot::base_color);
  return key_.vertex_colors ? color * input3(Input::vertex_color) : color;
}

Scalar SurfaceTerms::coverage() {
  if (b_.shape(Field::alpha_mode).alpha_mode != AlphaMode::blend) return number(1);
  Scalar alpha = field(Field::base_color, 3);
  if (has(Slot::base_color)) alpha = alpha * texel(Slot::base_color, 3);
  if (key_.vertex_colors) alpha = alpha * input(Input::vertex_color, 3);
  return alpha;
}

Scalar SurfaceTerms::occlusion() {
  if (!has(Slot::occlusion)) return number(1);
  return 1.0F + field(Field::occlusion_strength) * (texel(Slot::occlusion, 0) - 1.0F);
}

Triple SurfaceTerms::emission() {
  const Triple color = textured3(Field::emissive, Slot::emissive);
  return color * field(Field::emissive_strength);
}

MapAxes<Triple> SurfaceTerms::axes(Slot slot) {
  const Value frame = b_.tangent_frame(slot);
  const auto axis = [&](unsigned first) {
    return Triple{
        {&b_, b_.channel(frame, first)}, {&b_, b_.channel(frame, first + 1)}, {&b_, b_.channel(frame, first + 2)}};
  };
  return {axis(0), axis(3)};
}

Triple SurfaceTerms::normal(Slot slot, Field scale) {
  const Triple smooth = input3(Input::normal);
  if (!has(slot)) return smooth;
  const UnmappedNormals<Triple> normals{smooth, input3(Input::geometric), key_.inside};
  return mapped_normal(axes(slot), normals, texel3(slot), field(scale),
                       [](const Triple& bent, const Triple&) { return normalized(bent); });
}

Incidence SurfaceTerms::incidence(const VisibleLight& visible) {
  return incidence(
      traits_of(b_.scene().light(visible.light).kind), visible.filtered,
      [&](LightField f) { return Scalar{&b_, b_.light(visible.light, f)}; },
      [&] { return input3(Input::tint, visible.order); });
}

Incidence SurfaceTerms::incidence(LightKind kind, bool filtered) {
  return incidence(
      traits_of(kind), filtered, [&](LightField f) { return Scalar{&b_, b_.light_at_hand(f)}; },
      [&] { return input3(Input::tint, kPlaceAtHand); });
}

template <class Of, class Tint>
Incidence SurfaceTerms::incidence(const LightTraits& traits, bool filtered, const Of& of, const Tint& tint) {
  const Triple color{of(LightField::red), of(LightField::green), of(LightField::blue)};
  const Triple axis{of(LightField::dx), of(LightField::dy), of(LightField::dz)};
  Incidence arriving{axis * number(-1), color * of(LightField::intensity)};
  if (traits.has_place) {
    const Triple way = Triple{of(LightField::x), of(LightField::y), of(LightField::z)} - input3(Input::position);
    const Scalar distance2 = max(dot(way, way), 1e-8F);
    const Scalar distance = sqrt(distance2);
    arriving.direction = way * (1.0F / distance);
    const Scalar reach = distance * of(LightField::inverse_range);
    const Scalar reach2 = reach * reach;
    Scalar share = max(1.0F - reach2 * reach2, 0.0F) / distance2;
    if (traits.has_cone) {
      // Cosines near 1 have no digits left for narrow cones: 1 - cos is half the square of what lies between
      // directions.
      const Triple beside = arriving.direction + axis;
      const Scalar versine = dot(beside, beside) * 0.5F;
      const Scalar inwards = of(LightField::outer_versine) - versine;
      const Scalar t = min(max(inwards * of(LightField::inverse_cone_width), 0.0F), 1.0F);
      share = share * (t * t);
    }
    arriving.irradiance = arriving.irradiance * share;
  }
  if (filtered) arriving.irradiance = arriving.irradiance * tint();
  return arriving;
}

Scalar SurfaceTerms::ior() {
  const Scalar middle = field(Field::ior);
  if (channel_ == Channel::all || channel_ == Channel::green) return middle;
  const Scalar dispersion = field(Field::dispersion);
  return channel_ == Channel::red ? red_ior(middle, dispersion) : blue_ior(middle, dispersion);
}

Triple SurfaceTerms::beer(Scalar length) {
  const Triple color = field3(Field::attenuation_color);
  const Scalar depth = length / field(Field::attenuation_distance);
  return {exp2(log2(color.x) * depth), exp2(log2(color.y) * depth), exp2(log2(color.z) * depth)};
}

}  // namespace relook
