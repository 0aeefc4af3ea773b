// The paper's Table 2: pieces and bytes of each structure, beside the paper's for its complex scene (Figure 4).
#pragma once
#include "render_measures.h"

namespace relook {

/// `image`: preprocessed from `scene`; `resident`: of a replayer that has it.
void print_table2(const BenchOptions& options, const Scene& scene, const Image& image, const Resident& resident,
                  const RenderTimes& times);

}  // namespace relook
