// The paper's Table 2: pieces and bytes of each structure, beside the paper's for its complex scene (Figure 4). Pieces
// and bytes on disk are those of caches that `relook preprocess` writes, as `relook inspect` tells them.
#pragma once
#include "setup.h"

namespace relook {

/// `image`: preprocessed from the scene of `options`. `journal`: its first colour edit says for how many samples there
/// are colour trees; null: not said.
void print_table2(const BenchOptions& options, const Image& image, const Journal* journal);

}  // namespace relook
