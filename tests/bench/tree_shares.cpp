#include "tree_shares.h"

#include <cstdio>

namespace relook {

double share_of_trees_kept(const Image& image) {
  double kept = 0, all = 0;
  for (const TileTrees& trees : image.trees) {
    const auto samples = static_cast<double>(trees.paths.size());
    all += samples;
    if (has_hits(trees)) kept += samples;
  }
  return kept / all;
}

std::string tree_share_head(double share, double kept) {
  char text[32];
  if (share == 1)
    std::snprintf(text, sizeof text, "all ray trees");
  else
    std::snprintf(text, sizeof text, "%.0f %% (%.1f %%)", share * 100, kept * 100);
  return text;
}

}  // namespace relook
