// What hits send on, kept from one step to the next: of each ray behind a first hit the way that textures and point sets
// gave it, from which the tree is grown again without them, bit for bit. Derived from ray trees under Integrator::path;
// written and read by replay/path, held by StoredImage.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "trace/tree/tree_block.h"

namespace relook {

/// A ray to a node below the first. All else that SpawnedRay has follows from the hit that it left, but what only
/// spawning reads: a tree of restored rays cannot grow.
class KeptRay {
 public:
  KeptRay() = default;
  /// Requires: the block's node has a parent.
  KeptRay(const TreeBlock& block, const RayNode& node);
  /// `parent`: the completed node that it left, on `object`. `branch`: by which.
  [[nodiscard]] SpawnedRay restored(const RayNode& parent, const RayObject& object, Branch branch) const;
  /// Of the node that it leads to.
  [[nodiscard]] CoverageChoice coverage() const;

 private:
  [[nodiscard]] bool has(std::uint16_t flag) const { return (flags_ & flag) != 0; }

  Direction direction_{0, 0, 0};
  float density_ = 0;
  std::uint16_t flags_ = 0;     // of PathState, and how it left
  std::uint8_t widths_ = 0;     // what it spreads by and its alpha_floor, where they are not its parent's
  std::uint8_t coverage_ = 0;   // way and bucket
};
static_assert(sizeof(KeptRay) == 20);

/// Of the samples of a tile. Rays stand as nodes do, without each sample's first.
struct TileRays {
  std::vector<std::uint32_t> first{0};  // [samples + 1] into rays
  std::vector<KeptRay> rays;
  std::vector<Color> weights;  // of `rays`: what of unit light at their ends comes to the eye; empty: not known

  [[nodiscard]] bool empty() const { return first.size() == 1; }
  [[nodiscard]] bool has_weights() const { return weights.size() == rays.size(); }
  [[nodiscard]] std::size_t samples() const { return first.size() - 1; }
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::span<const KeptRay> of(std::size_t sample) const {
    return std::span(rays).subspan(first[sample], first[sample + 1] - first[sample]);
  }
  [[nodiscard]] std::span<const Color> weights_of(std::size_t sample) const {
    return std::span(weights).subspan(first[sample], first[sample + 1] - first[sample]);
  }
  /// Appends the rays of the tree that begins at `root`.
  void append(const TreeBlock& block, std::uint32_t root);
  /// Appends a sample of another tile's rays, with its weights if both have them.
  void append(const TileRays& other, std::size_t sample);
};

}  // namespace relook
