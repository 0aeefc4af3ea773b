// Compresses nodes whose program adds whichever lamps reach them (expression/pieces.h): columns of the nodes and, for
// each lamp, of the nodes that it reaches. Called by compress.cpp.
#pragma once
#include <span>
#include <vector>

#include "color/compress/compressed_block.h"

namespace relook {

/// What of the lamps and their filters changes.
struct ChangingLight {
  const ParameterSet& parameters;
  const std::vector<bool>& filters;              // by filter of the block
  const std::vector<std::uint32_t>& filter_slots;  // likewise: those of the compressed block
};

/// The parameters of lamps that reach any of the nodes, added to what a program reads.
[[nodiscard]] Dependencies with_lamps(Dependencies read, const ColorScene& scene, const TreeBlock& block,
                                      std::span<const std::uint32_t> nodes);

/// Fills the columns and sums of a batch and notes what they were evaluated with. `bound`: with sums; of the batch's
/// nodes, whose known children and filters have their colours in `memory`.
void compress_sums(CompressedBatch& batch, const BoundProgram& bound, const NodeBatch& nodes,
                   const ChangingLight& changing, ColorMemory& memory, Baked& baked);

}  // namespace relook
