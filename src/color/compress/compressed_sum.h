// What lamps add to a sum of compressed nodes: nothing is kept for nodes that a lamp does not reach.
#pragma once
#include <cstdint>
#include <vector>

#include "color/compress/split.h"
#include "color/compress/stored_columns.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// Lanes of a batch that a lamp reaches in one way.
struct LitLanes {
  LightId light;
  const SplitTerm* term = nullptr;
  std::vector<std::uint32_t> lanes;
  std::vector<LightLink> links;  // [lanes] slots of the filters before the lamp, where these change; else empty
  StoredColumns columns;         // [lanes] of the term

  [[nodiscard]] std::size_t bytes() const {
    return sizeof(*this) + lanes.size() * sizeof(std::uint32_t) + links.size() * sizeof(LightLink) + columns.bytes();
  }
};

/// A sum of a batch, if it changes; empty otherwise.
struct CompressedSum {
  StoredColumns start;        // R, G, B of the sum with the light of lamps before the first that changes; or empty
  std::vector<LitLanes> lit;  // what follows, in the light order

  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = sizeof(*this) + start.bytes();
    for (const LitLanes& lamp : lit) sum += lamp.bytes();
    return sum;
  }
};

}  // namespace relook
