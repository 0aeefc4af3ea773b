// Per-sample constants of colour programs: columns gathered from the nodes or filters of a block.
#pragma once
#include <span>

#include "color/expression/evaluate.h"

namespace relook {

/// Some nodes or filters of a block.
struct Gathering {
  const RayScene& scene;
  const TreeBlock& block;
  bool are_filters = false;
  std::span<const std::uint32_t> indices;  // at most kLanes
};

/// Fills out[lane] with an input.
void gather(Payload payload, const Gathering& from, const BlockColors& colors, float* out);
/// Slots with the same have the same coordinates at every hit.
[[nodiscard]] std::uint32_t mapping_key(const TextureSlot& slot);
/// Op::coordinates: four columns.
void gather_coordinates(const TextureSlot& slot, const Gathering& from, Column* out);
/// Op::tangent_frame: six columns.
void gather_tangent_frames(const TextureSlot& slot, const Gathering& from, Column* out);

}  // namespace relook
