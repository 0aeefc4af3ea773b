// The geometric rows of the paper's Table 3: removing, rendering and adding of a selection, with 0, 1 and 2 tunnels.
#pragma once
#include "setup.h"

namespace relook {

/// Prints the drags and geometric edits of the journal. `image`: preprocessed from the scene of `options`.
void print_moves(const BenchOptions& options, const Image& image, const Journal& journal, double full_seconds);

}  // namespace relook
