// Evaluates whole blocks of ray trees: filters first, then nodes by generation, the deepest first, batched by program.
// Trees in, a colour for each node and filter out. What Shader and PartShader have in common, inside src/color.
#pragma once
#include <span>
#include <vector>

#include "color/node_programs.h"

namespace relook {

class BlockShading {
 public:
  explicit BlockShading(const ColorScene& scene) : scene_(scene) {}

  /// The three fill their part of colors(). `programs`: of the scene of the constructor.
  void shade_filters(const TreeBlock& block, NodePrograms& programs);
  /// All nodes. Requires: the colours of the filters are there.
  void shade_nodes(const TreeBlock& block, NodePrograms& programs);
  /// Some nodes. Requires: the colours of the filters and of what these nodes spawned are there.
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
