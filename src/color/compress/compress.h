// From the ray trees of a block to compressed colour trees (paper 3.3): finds the nodes that a set of parameters can
// reach, evaluates what hangs on them and cannot change, and stores the columns of the others. Called by
// Shader::compress().
#pragma once
#include "color/compress/compressed_block.h"

namespace relook {

class NodePrograms;

/// What compressing needs beside the trees. `programs`: of the block's nodes; `memory`: working memory.
struct CompressContext {
  const ColorScene& scene;
  NodePrograms& programs;
  SplitTable& splits;
  ColorMemory& memory;
};

/// See Shader::compress().
[[nodiscard]] CompressedBlock compress_block(const TreeBlock& block, std::span<const std::uint32_t> roots,
                                             const ParameterSet& parameters, const CompressContext& context);

}  // namespace relook
