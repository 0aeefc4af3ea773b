// Ray trees (paper 2.2) in their compact form: per hit the primitive and the barycentrics; everything else follows from
// the path, the object and the parent. Stored per tile, sample by sample.
#pragma once
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <vector>

#include "base/id.h"

namespace relook {

/// Where a ray met its object: the paper's point-dependent information in 12 bytes.
struct Hit {
  std::uint32_t primitive = 0;
  float u = 0, v = 0;  // weights of the triangle's second and third vertex
  bool operator==(const Hit&) const = default;
};

/// A place among the hits of a tile as it is kept. Throws std::bad_alloc where they are more than it can tell.
[[nodiscard]] inline std::uint32_t hit_place(std::size_t hits) {
  if (hits > 0xFFFFFFFFU) throw std::bad_alloc();
  return static_cast<std::uint32_t>(hits);
}

/// The ray trees of one tile, whose samples are numbered as base/tiles.h says. Hits of a sample: nodes in preorder,
/// each followed by the filters of its lights, as in the path.
struct TileTrees {
  std::vector<PathId> paths;             // [samples]
  std::vector<std::uint32_t> first_hit;  // [samples + 1] into hits; empty, as hits: not kept
  std::vector<Hit> hits;

  [[nodiscard]] std::span<const Hit> hits_of(std::size_t sample) const {
    return {hits.data() + first_hit[sample], first_hit[sample + 1] - first_hit[sample]};
  }
  /// The same where they are kept, be they none at all (a sample that sees no object); without a value where not.
  [[nodiscard]] std::optional<std::span<const Hit>> kept_hits_of(std::size_t sample) const {
    if (first_hit.empty()) return std::nullopt;
    return hits_of(sample);
  }
};

}  // namespace relook
