// The parts that illumination models share: textured parameters, normals, lamps, child rays.
#pragma once
#include "color/expression/expression.h"
#include "color/surface/node_key.h"
#include "physics/normal_map.h"

namespace relook {

/// Light arriving from one lamp at a node.
struct Incidence {
  Triple direction;   // unit, towards the lamp
  Triple irradiance;  // at normal incidence, tinted
};

class SurfaceTerms {
 public:
  SurfaceTerms(ExpressionBuilder& builder, const NodeKey& key) : b_(builder), key_(key) {}

  [[nodiscard]] Scalar number(float x) { return {&b_, b_.constant(x)}; }
  [[nodiscard]] Triple grey(float x) { return {number(x), number(x), number(x)}; }
  [[nodiscard]] Scalar field(Field f, unsigned component = 0) { return {&b_, b_.field(f, component)}; }
  [[nodiscard]] Triple field3(Field f) { return {field(f, 0), field(f, 1), field(f, 2)}; }
  [[nodiscard]] Scalar input(Input i, unsigned axis = 0, std::uint32_t which = 0) {
    return {&b_, b_.input(i, axis, which)};
  }
  [[nodiscard]] Triple input3(Input i, std::uint32_t which = 0) {
    return {input(i, 0, which), input(i, 1, which), input(i, 2, which)};
  }
  [[nodiscard]] bool has(Slot slot) { return b_.has_texture(slot); }
  [[nodiscard]] Scalar texel(Slot slot, unsigned channel) { return {&b_, b_.texel(slot, channel)}; }
  [[nodiscard]] Triple texel3(Slot slot) { return {texel(slot, 0), texel(slot, 1), texel(slot, 2)}; }
  /// A factor times a channel of its texture, if it has one.
  [[nodiscard]] Scalar textured(Field f, Slot slot, unsigned channel);
  [[nodiscard]] Triple textured3(Field f, Slot slot);

  [[nodiscard]] Triple base_color();
  [[nodiscard]] Scalar coverage();  // 1 unless alpha mode BLEND
  [[nodiscard]] Scalar occlusion();
  [[nodiscard]] Triple emission();
  [[nodiscard]] Triple normal(Slot slot, Field scale);
  /// The axes of a map; zero where the mesh gives none.
  [[nodiscard]] MapAxes<Triple> axes(Slot slot);
  [[nodiscard]] Triple view() { return input3(Input::view); }
  [[nodiscard]] Triple ambient() { return {{&b_, b_.ambient(0)}, {&b_, b_.ambient(1)}, {&b_, b_.ambient(2)}}; }

  [[nodiscard]] bool counts(Source source) const { return (key_.sources & source) != 0; }
  [[nodiscard]] Incidence incidence(const VisibleLight& light);
  /// The light of whichever lamp is at hand: in what one lamp adds to a sum (LampSum).
  [[nodiscard]] Incidence incidence(LightKind kind, bool filtered);
  /// A sum and the light of the lamps that reach the node, one after the other. `reflected`: of a lamp's direction, the
  /// value of lobes times NL.
  template <class Reflected>
  [[nodiscard]] Triple with_lamps(Triple sum, const Reflected& reflected) {
    const auto light = [&](const Incidence& lamp) { return reflected(lamp.direction) * lamp.irradiance; };
    if (!key_.sums) {
      for (const VisibleLight& lamp : key_.lights) sum = sum + light(incidence(lamp));
      return sum;
    }
    LampSum of;
    of.before = of_channel(sum);
    for (const LightId lamp : b_.scene().light_order)
      for (const bool filtered : {false, true}) {
        const LightKind kind = b_.scene().light(lamp).kind;
        auto& term = of.terms[light_term(kind, filtered)];
        if (!term) term = of_channel(light(incidence(kind, filtered)));
      }
    const LampSum::Rgb whole = b_.sum(std::move(of));
    return {{&b_, whole[0]}, {&b_, whole[1]}, {&b_, whole[2]}};
  }
  [[nodiscard]] bool has_child(Branch branch) const { return key_.children.has(branch); }
  [[nodiscard]] Triple child(Branch branch) { return input3(Input::child, static_cast<std::uint32_t>(branch)); }
  [[nodiscard]] Scalar child_alpha(Branch branch) {
    return input(Input::child, 3, static_cast<std::uint32_t>(branch));
  }
  /// From here on the expression is that of light of one channel.
  void take(Channel channel) { channel_ = channel; }
  [[nodiscard]] Scalar ior();
  /// The branch of the refracted ray: one of its own for each channel where colours part.
  [[nodiscard]] Branch refraction() const {
    return (key_.children & BranchSet::parted()).empty() ? Branch::refraction : refracted(channel_);
  }
  /// Beer's law over `length` metres inside the material.
  [[nodiscard]] Triple beer(Scalar length);

  [[nodiscard]] ExpressionBuilder& builder() { return b_; }
  [[nodiscard]] const NodeKey& key() const { return key_; }

 private:
  /// `of`: a field of the lamp; `tint`: that of what stands before it.
  template <class Of, class Tint>
  [[nodiscard]] Incidence incidence(const LightTraits& traits, bool filtered, const Of& of, const Tint& tint);
  /// The channels that are asked for.
  [[nodiscard]] LampSum::Rgb of_channel(const Triple& color) {
    const auto one = [&](Channel channel, Scalar value) {
      return channel_ == Channel::all || channel_ == channel ? value.value : b_.constant(0);
    };
    return {one(Channel::red, color.x), one(Channel::green, color.y), one(Channel::blue, color.z)};
  }

  ExpressionBuilder& b_;
  const NodeKey& key_;
  Channel channel_ = Channel::all;
};

}  // namespace relook
