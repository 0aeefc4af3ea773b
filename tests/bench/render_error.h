// How far pictures of the path integrator are from converged ones, beside those of a standard path tracer
// (tests/oracle/standard_tracer.h) with as many samples, on small scenes of its own.
#pragma once
#include <string>
#include <vector>

#include "setup.h"

namespace relook {

/// `words`: [WIDTHxHEIGHT [SAMPLES]]; 96x64, 16. Throws UsageError.
[[nodiscard]] BenchOptions error_options(const std::vector<std::string>& words);

/// Prints, by scene, both errors and their ratio, then what each of relook's choices costs the standard tracer. Reads
/// size, samples and record of the options. Throws IoError.
void print_errors(const BenchOptions& options);

}  // namespace relook
