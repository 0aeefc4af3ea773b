// What edits cost under the path integrator, as shares of its full render.
#pragma once
#include "setup.h"

namespace relook {

/// Prints the full render, its rays beside a bare loop over the same, preprocessing, memory a vertex, and every edit of
/// the journal: the first time and the second, after it was taken back. 64 samples where the command line says none.
void print_light(const BenchOptions& options);

}  // namespace relook
