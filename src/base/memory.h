// Memory of this process as the operating system counts it.
#pragma once
#include <cstdint>

namespace relook {

/// The resident set now.
[[nodiscard]] std::uint64_t resident_set_bytes();

/// Gives back what is free inside of the allocator's own blocks.
void trim_allocator();

}  // namespace relook
