// Does a replay keep within --memory? Whole processes, as the operating system counts them, for five limits.
#pragma once
#include <string>

namespace relook {

/// `cache`: a cache folder. Throws Error if the journal cannot be replayed from it without a limit.
void print_peaks(const std::string& cache, const std::string& journal);

}  // namespace relook
