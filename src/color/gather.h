// Per-sample constants of colour programs: columns gathered from the nodes of a block.
#pragma once
#include <span>

#include "color/evaluate.h"

namespace relook {

/// Fills out[0 .. indices.size()) with input `payload` (Input | detail << 8) of the nodes or filters `indices`.
void gather(std::uint32_t payload, MaterialId material, const RayScene& scene, const TreeBlock& block, bool are_filters,
            std::span<const std::uint32_t> indices, const BlockColors& colors, Column& out);

}  // namespace relook
