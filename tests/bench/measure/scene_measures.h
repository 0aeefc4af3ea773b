// All measures of one scene, as `relook_bench SCENE JOURNAL` prints them, and the paper's tables alone.
#pragma once
#include "setup.h"

namespace relook {

void print_scene(const BenchOptions& options);
/// Tables 2 and 3. Throws InputError without a journal.
void print_tables(const BenchOptions& options);

}  // namespace relook
