// Columns of Table 3 by share of ray trees.
#pragma once
#include <string>

#include "frame/image.h"

namespace relook {

/// Of the samples.
[[nodiscard]] double share_of_trees_kept(const Image& image);
/// "10 % (9.9 %)": what was asked for, and in brackets what was kept.
[[nodiscard]] std::string tree_share_head(double share, double kept);

}  // namespace relook
