// Memory of this process as the operating system counts it.
#pragma once
#include <cstdint>

namespace relook {

/// The resident set now.
[[nodiscard]] std::uint64_t resident_set_bytes();

/// Makes blocks of 16 KB and more leave the resident set when they are freed: for a process that has to keep within a
/// budget. Costs time at each allocation. Call before other work.
void return_freed_memory();

}  // namespace relook
