// What all evaluation of whole blocks of ray trees has in common, inside src/color: filters first, then nodes by
// generation, the deepest first.
#pragma once
#include <span>
#include <vector>

#include "color/node_programs.h"

namespace relook {

class BlockShading {
 public:
  explicit BlockShading(const ColorScene& scene) : scene_(scene) {}

  /// Each fills its part of colors(). `programs`: of this scene.
  void shade_filters(const TreeBlock& block, NodePrograms& programs);
  /// Requires: the filters are there.
  void shade_nodes(const TreeBlock& block, NodePrograms& programs);
  /// Some nodes only. Requires: the filters and what these nodes spawned are there.
  void shade_nodes(const TreeBlock& block, NodePrograms& programs, std::span<const std::uint32_t> nodes);

  [[nodiscard]] const BlockColors& colors() const { return memory_.colors; }
  [[nodiscard]] ColorMemory& memory() { return memory_; }

 private:
  const ColorScene& scene_;
  ColorMemory memory_;
  Batches batches_;
  std::vector<std::uint32_t> batch_of_, chosen_;
};

}  // namespace relook
