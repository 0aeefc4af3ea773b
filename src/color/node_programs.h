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
[[nodiscard]] NodeKey filter_key(const RayScene& scene, ObjectId id);

/// A short form of NodeKey that is cheap to make and compare: (material, flags), light states.
struct Signature {
  std::uint64_t surface = 0, lights = 0;
  bool operator==(const Signature&) const = default;
};
struct SignatureHash {
  std::size_t operator()(const Signature& s) const {
    return (s.surface * 0x9E3779B97F4A7C15ULL) ^ (s.lights * 0xC2B2AE3D27D4EB4FULL);
  }
};

/// Gives nodes and filters dense numbers of programs. The programs of nodes, not of filters, are restricted to a part
/// of their colours.
class NodePrograms {
 public:
  NodePrograms(const RayScene& scene, ProgramTable& table, const ColorPart& part = {})
      : scene_(scene), table_(table), part_(part), lamp_place_(place_of_lamp()) {}

  std::uint32_t number(const TreeBlock& block, const RayNode& node);
  std::uint32_t number(const TreeBlock&, const FilterNode& filter) {
    Signature signature{surface_bits(filter.object, filter.point.inside, 0) | kFilterBit, 0};
    return number(signature, [&] {
      NodeKey key = filter_key(scene_, filter.object);
      key.inside = filter.point.inside;
      return key;
    });
  }
  [[nodiscard]] const BoundProgram& program(std::uint32_t number) const { return programs_[number]; }
  [[nodiscard]] std::size_t size() const { return programs_.size(); }

 private:
  static_assert(kMostTellingLights <= 32, "a signature has two bits a light");
  static constexpr std::uint64_t kFilterBit = std::uint64_t{1} << 63;

  [[nodiscard]] std::uint64_t surface_bits(ObjectId id, bool inside, std::uint64_t children) const {
    const RayObject& object = scene_.object(id);
    return std::uint64_t{scene_.scene().object(id).material.index()} << 16 | children << 8 | (inside ? 1U : 0U) |
           (object.mesh->colors.empty() ? 0U : 2U) | (object.optics.volume && inside ? 4U : 0U) | 8U;
  }
  [[nodiscard]] static std::uint64_t light_bits(ShadowState state) {  // only how a light reaches the node counts
    return state == ShadowState::open ? 1 : state == ShadowState::filtered ? 2 : 0;
  }
  /// `lights`: how many lights of the light order count, from the first.
  [[nodiscard]] Signature signature_of(const TreeBlock& block, const RayNode& node, std::size_t lights) const {
    if (node.object.is_none()) return {};
    std::uint64_t children = 0;
    for (std::size_t b = 0; b < kBranches; ++b) children |= std::uint64_t{node.child[b] != kNoNode} << b;
    Signature signature{surface_bits(node.object, node.point.inside, children), 0};
    const LightLink* links = block.lights.data() + node.first_light;
    for (std::size_t light = 0; light < lights; ++light)
      signature.lights |= light_bits(links[light].state) << (2 * light);
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

  const RayScene& scene_;
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
