// Every measure in one command: on spheres, and on garden, which is generated first, at the paper's size and at
// 1920x1080 unless a size is given. The goals are for garden.
#pragma once
#include <string>
#include <vector>

namespace relook {

/// `words`: [WIDTHxHEIGHT [SAMPLES]] [--json FILE] [--html FILE]. Prints all measures, then those with a goal, and
/// writes the files. Throws UsageError, InputError, IoError.
void print_all(const std::vector<std::string>& words);

}  // namespace relook
