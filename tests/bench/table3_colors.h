// Colour rows of Table 3: the price of an edit from ray trees, of the first edit that is compressed, and of later ones.
#pragma once
#include "setup.h"

namespace relook {

void print_colors(const BenchOptions& options, const Image& image, const Journal& journal, double full_seconds);

}  // namespace relook
