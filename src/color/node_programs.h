// The programs of the nodes of one block, as dense numbers, and batches of nodes with equal numbers: what shading
// (block_shading.h) and compressing (compress/compress.cpp) have in common, inside src/color. Nodes with the same key
// have the same program.
#pragma once
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "color/shade.h"

namespace relook {

/// The key of a filter, as if light met it from outside: the caller sets `inside`, which depends on the hit.
[[nodiscard]] NodeKey filter_key(const ColorScene& scene, ObjectId id);

/// What of a surface, beside its material, its programs differ by.
struct SurfaceForm {
  bool inside = false, vertex_colors = false, interface_only = false;
};

/// A short form of NodeKey that is cheap to make and compare. One of its own for the environment.
class Signature {
 public:
  constexpr Signature() = default;  // the environment
  constexpr Signature(NodeKind kind, MaterialId material, const SurfaceForm& form, BranchSet children)
      : surface_(std::uint64_t{material.index()} << kMaterialShift | std::uint64_t{children.bits()} << kChildrenShift |
                 kIsSurface | (form.inside ? kInside : 0U) | (form.vertex_colors ? kVertexColors : 0U) |
                 (form.interface_only ? kInterfaceOnly : 0U) | (kind == NodeKind::filter ? kIsFilter : 0U)) {}
  /// Only how a light reaches the node counts. `place`: each once, below kMostTellingLights.
  constexpr void add_light(std::size_t place, ShadowState state) {
    const std::uint64_t bits = state == ShadowState::open ? 1 : state == ShadowState::filtered ? 2 : 0;
    lights_ |= bits << (2 * place);
  }
  [[nodiscard]] constexpr std::size_t hash() const {
    return (surface_ * 0x9E3779B97F4A7C15ULL) ^ (lights_ * 0xC2B2AE3D27D4EB4FULL);
  }
  friend constexpr bool operator==(const Signature&, const Signature&) = default;

 private:
  static constexpr unsigned kChildrenShift = 8, kMaterialShift = 16;
  static constexpr std::uint64_t kInside = 1, kVertexColors = 2, kInterfaceOnly = 4, kIsSurface = 8,
                                 kIsFilter = std::uint64_t{1} << 63;
  std::uint64_t surface_ = 0;
  std::uint64_t lights_ = 0;  // two bits a light
};
static_assert(sizeof(Signature) == 16 && kMostTellingLights <= 32);
struct SignatureHash {
  std::size_t operator()(const Signature& signature) const { return signature.hash(); }
};

/// Gives nodes and filters dense numbers of programs. The programs of nodes, not of filters, are restricted to a part
/// of their colours.
class NodePrograms {
 public:
  NodePrograms(const ColorScene& scene, ProgramTable& table, const ColorPart& part = {})
      : scene_(scene), table_(table), part_(part), lamp_place_(place_of_lamp()) {}

  std::uint32_t number(const TreeBlock& block, const RayNode& node);
  std::uint32_t number(const TreeBlock&, const FilterNode& filter) {
    return number(signature_of(NodeKind::filter, filter.object, filter.point.inside, {}), [&] {
      NodeKey key = filter_key(scene_, filter.object);
      key.inside = filter.point.inside;
      return key;
    });
  }
  [[nodiscard]] const BoundProgram& program(std::uint32_t number) const { return programs_[number]; }
  [[nodiscard]] std::size_t size() const { return programs_.size(); }

 private:
  [[nodiscard]] Signature signature_of(NodeKind kind, ObjectId id, bool inside, BranchSet children) const {
    const RayObject& object = scene_.object(id);
    const SurfaceForm form{inside, !object.mesh->colors.empty(), object.optics.volume && inside};
    return {kind, scene_.scene().object(id).material, form, children};
  }
  /// `lights`: how many lights of the light order count, from the first.
  [[nodiscard]] Signature signature_of(const TreeBlock& block, const RayNode& node, std::size_t lights) const {
    if (node.object.is_none()) return {};
    Signature signature = signature_of(NodeKind::surface, node.object, node.point.inside, children_of(node));
    const LightLink* links = block.lights.data() + node.first_light;
    for (std::size_t light = 0; light < lights; ++light) signature.add_light(light, links[light].state);
    return signature;
  }
  [[nodiscard]] std::size_t place_of_lamp() const;
  template <class MakeKey>
  std::uint32_t number(const Signature& signature, const MakeKey& make_key) {
    if (has_last_ && signature == last_) return last_number_;
    const auto [it, is_new] = numbers_.try_emplace(signature, static_cast<std::uint32_t>(programs_.size()));
    if (is_new) programs_.push_back(table_.get(scene_.scene(), make_key()));
    has_last_ = true;
    last_ = signature;
    last_number_ = it->second;
    return last_number_;
  }

  const ColorScene& scene_;
  ProgramTable& table_;
  ColorPart part_;
  std::size_t lamp_place_;  // place of the part's only lamp in the light order; its length if there is none
  std::unordered_map<Signature, std::uint32_t, SignatureHash> numbers_;
  std::vector<BoundProgram> programs_;
  bool has_last_ = false;
  Signature last_;
  std::uint32_t last_number_ = 0;
};

/// Indices sorted by batch, stable.
class Batches {
 public:
  /// Calls run(batch, indices) for each batch that occurs, in increasing order. `batch_of`: of index i, below
  /// `batches`.
  template <class Run>
  void for_each(std::span<const std::uint32_t> batch_of, std::size_t batches, const Run& run) {
    first_.assign(batches + 1, 0);
    for (std::uint32_t batch : batch_of) ++first_[batch + 1];
    for (std::size_t b = 0; b < batches; ++b) first_[b + 1] += first_[b];
    next_.assign(first_.begin(), first_.end() - 1);
    sorted_.resize(batch_of.size());
    for (std::size_t i = 0; i < batch_of.size(); ++i) sorted_[next_[batch_of[i]]++] = static_cast<std::uint32_t>(i);
    for (std::size_t b = 0; b < batches; ++b)
      if (first_[b] != first_[b + 1]) run(b, std::span(sorted_).subspan(first_[b], first_[b + 1] - first_[b]));
  }

 private:
  std::vector<std::uint32_t> first_, next_, sorted_;
};

}  // namespace relook
