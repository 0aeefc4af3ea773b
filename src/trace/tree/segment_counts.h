// Where the stored segments of ray trees stay when a change is looked for in them (paper 2.2, 3.4): each is tested
// against the selection, or culled for exactly one reason.
#pragma once
#include <cstdint>

namespace relook {

/// Stored segments that are not tested, by what rules them out first.
struct CulledSegments {
  std::uint64_t tunnels = 0;   // in regions, or of branch histories and lights, that tunnels rule out
  std::uint64_t by_class = 0;  // on which this kind of change can do nothing
  std::uint64_t boxes = 0;     // that miss the box around the selection
  std::uint64_t dropped = 0;   // gone: to a node of the selection, below a node that has changed, to a light that has

  [[nodiscard]] std::uint64_t sum() const { return tunnels + by_class + boxes + dropped; }
  CulledSegments& operator+=(const CulledSegments& other) {
    tunnels += other.tunnels;
    by_class += other.by_class;
    boxes += other.boxes;
    dropped += other.dropped;
    return *this;
  }
};

}  // namespace relook
