// The paper's Table 3: all steps of a journal, and of its colour and optical rows what finding the samples costs.
#pragma once
#include "setup.h"

namespace relook {

/// Prints every step of the journal, replayed once in order.
void print_steps(const BenchOptions& options, Replayer& replayer, const Journal& journal, double full_seconds);

/// Prints the colour and optical steps with and without groups. `image`: preprocessed from the scene of `options`.
void print_looks(const BenchOptions& options, const Image& image, const Journal& journal, double full_seconds);

}  // namespace relook
