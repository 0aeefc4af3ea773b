// Runs a colour program over a batch of nodes of a block of ray trees.
#pragma once
#include <span>
#include <vector>

#include "color/color_scene.h"
#include "color/expression/lanes.h"
#include "color/expression/node_sums.h"
#include "color/expression/program.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// Colours computed so far for the nodes and filters of a block.
struct BlockColors {
  std::vector<Rgba> nodes;    // [block.nodes]
  std::vector<Rgba> filters;  // [block.filters]
};

/// Working memory, reused between calls.
struct ColorMemory {
  BlockColors colors;
  Scratch scratch;
  SumMemory sums;
};

/// Does a light with this state shed anything on the node?
[[nodiscard]] constexpr bool reaches(ShadowState state) {
  return state == ShadowState::open || state == ShadowState::filtered;
}

/// The product of the filters between a node and a light.
[[nodiscard]] inline float tint(const LightLink& link, int channel, const BlockColors& colors) {
  float product = 1;
  for (std::uint32_t f = 0; f < link.filters; ++f) product *= colors.filters[link.first + f][channel];
  return product;
}

/// A program and the material whose parameters its leaves read.
struct BoundProgram {
  const ColorProgram* program = nullptr;
  MaterialId material;
};

/// Nodes of a block (or filters, if `are_filters`) that share a program, as what a kernel runs over. The children and
/// filters of the nodes must be there already, as far as the kernel reads them.
struct NodeBatch {
  const ColorScene& scene;
  const TreeBlock& block;
  const BlockColors& colors;
  bool are_filters = false;
  std::span<const std::uint32_t> indices;

  void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters& parameters,
            Scratch& scratch) const;
};

/// Runs a program for nodes (or filters) `indices` of `block` and stores their colours in memory.colors.
void evaluate(const BoundProgram& bound, const ColorScene& scene, const TreeBlock& block, bool are_filters,
              std::span<const std::uint32_t> indices, ColorMemory& memory);

}  // namespace relook
