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
  /// A sum and what a light adds to it, where it reaches the node.
  [[nodiscard]] Triple with(const VisibleLight& light, const Triple& sum, const Triple& added) {
    if (!light.asked) return sum + added;
    return if_positive(input(Input::reached, 0, light.order), sum + added, sum);
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
  ExpressionBuilder& b_;
  const NodeKey& key_;
  Channel channel_ = Channel::all;
};

}  // namespace relook
