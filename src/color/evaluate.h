// Runs a colour program over a batch of nodes, column by column: every step is a loop over lanes that the compiler
// vectorises. Lanes do not interact, so the bits do not depend on how nodes are batched.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "color/program.h"
#include "trace/ray_scene.h"
#include "trace/tree_block.h"

namespace relook {

inline constexpr std::size_t kLanes = 128;
using Column = std::array<float, kLanes>;

/// Colours computed so far for the nodes and filters of a block.
struct BlockColors {
  std::vector<Rgba> nodes;    // [block.nodes]
  std::vector<Rgba> filters;  // [block.filters]
};

/// Working memory of evaluate(), reused between calls.
struct Scratch {
  std::vector<Column> registers;
};

/// A program and the material whose parameters its leaves read.
struct BoundProgram {
  const ColorProgram* program = nullptr;
  MaterialId material;
};

/// Runs a program for nodes (or filters, if `are_filters`) `indices` of `block` and stores their colours. The children
/// and filters of the nodes must be there already.
void evaluate(const BoundProgram& bound, const RayScene& scene, const TreeBlock& block, bool are_filters,
              std::span<const std::uint32_t> indices, BlockColors& colors, Scratch& scratch);

}  // namespace relook
