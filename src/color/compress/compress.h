// From ray trees to compressed colour trees (paper 3.3).
#pragma once
#include "color/compress/compressed_block.h"

namespace relook {

class NodePrograms;

/// What compressing needs beside the trees; `memory` is working memory.
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
