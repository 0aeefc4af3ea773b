// From ray trees in flight to their compact form: the words of a path (ray_path.h) and its hits (ray_tree.h).
#pragma once
#include <cstdint>
#include <vector>

#include "trace/tree/ray_path.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// The path words of the sample whose nodes start at `root`, appended to `words`; its hits appended to `hits`.
void pack(const TreeBlock& block, std::uint32_t root, const PathLayout& layout, std::vector<std::uint32_t>& words,
          std::vector<Hit>& hits);

}  // namespace relook
