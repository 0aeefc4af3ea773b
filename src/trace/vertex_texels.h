// The texels of a hit that decide which rays leave it. All lookups are placed, and their texels asked for, before the
// first is read, and slots that are mapped alike share their coordinates. Called by spawn.h and lobes.h.
#pragma once
#include <array>
#include <initializer_list>

#include "scene/texture/texel_taps.h"
#include "trace/ray_object.h"

namespace relook {

struct RayNode;

class VertexTexels {
 public:
  /// Of a completed node. `slots`: at most four; others may be asked for, too.
  VertexTexels(const RayNode& node, const RayObject& object, std::initializer_list<Slot> slots);
  /// As texel_at (tree/tree_block.h) has it.
  [[nodiscard]] Rgba at(Slot slot) const;

 private:
  struct Placed {
    Slot slot;
    TexelTaps taps;
  };
  const RayNode& node_;
  const RayObject& object_;
  std::size_t count_ = 0;
  std::array<Placed, 4> placed_;  // the first `count_`
};

}  // namespace relook
