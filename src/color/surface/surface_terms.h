// The parts that illumination models share: textured parameters, normals, lamps, child rays, Fresnel terms.
#pragma once
#include "color/expression/expression.h"
#include "color/surface/illumination.h"

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
  /// The axes of a map, for the front of the surface; zero where the mesh gives none.
  struct Axes {
    Triple tangent, bitangent;
  };
  [[nodiscard]] Axes axes(Slot slot);
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

[[nodiscard]] inline Scalar fifth_power(Scalar m) {
  const Scalar m2 = m * m;
  return m2 * m2 * m;
}
/// Schlick's weight (1 - c)^5 for a cosine in [0, 1].
[[nodiscard]] inline Scalar schlick(Scalar cosine) { return fifth_power(1.0F - min(cosine, 1.0F)); }
/// The share of a mirror ray that a roughness leaves: 1 at 0, 0 from the mirror threshold on.
[[nodiscard]] Scalar mirror_fade(Scalar roughness);

/// What an illumination model says about a surface, before coverage.
[[nodiscard]] Triple metallic_roughness_color(SurfaceTerms& terms);
[[nodiscard]] Triple blinn_phong_color(SurfaceTerms& terms);

}  // namespace relook
