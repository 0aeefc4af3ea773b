// What an edit costs with its files: frames as replays write them, and a whole process from its start.
#pragma once
#include "setup.h"

namespace relook {

/// Prints the full render and the smaller colour edits of the journal with their EXR frames, as ratios, and the time of
/// a `relook replay` of its first colour edit from start to end. `image`: preprocessed from the scene of `options`.
void print_files(const BenchOptions& options, const Image& image, const Journal& journal);

}  // namespace relook
