// How the time of an edit grows with the image: by affected sample it should stay the same.
#pragma once
#include "setup.h"

namespace relook {

/// Prints, at 0.1, 1 and 8 million samples, the time of a colour, an optical and a geometric edit, and of a move that
/// touches nothing seen. The journal has steps named as those of the paper's Table 3.
void print_growth(const BenchOptions& options);

}  // namespace relook
