// What a shadow counter of b bits says of n blockers (paper 4.2), from an integer without bounds: the oracle of tests.
#pragma once
#include <cstdint>

namespace relook {

[[nodiscard]] inline std::uint32_t word_of(std::uint64_t blockers, std::uint32_t bits) {
  const std::uint64_t fits = (std::uint64_t{1} << bits) - 1;
  return static_cast<std::uint32_t>(blockers <= fits ? blockers : fits + 1);
}

}  // namespace relook
