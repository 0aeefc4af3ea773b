// All measures of one scene, as `relook_bench SCENE JOURNAL` prints them.
#pragma once
#include "setup.h"

namespace relook {

void print_scene(const BenchOptions& options);

}  // namespace relook
