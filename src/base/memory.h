// Memory of this process as the operating system counts it.
#pragma once
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace relook {

/// The resident set now.
[[nodiscard]] std::uint64_t resident_set_bytes();

/// Keeps a value until the process ends, and its memory with it: for what would take long to take apart for nothing.
template <class T>
void keep_to_the_end(T value) {
  static std::vector<std::unique_ptr<T>>& kept = *new std::vector<std::unique_ptr<T>>();  // never destroyed
  kept.push_back(std::make_unique<T>(std::move(value)));
}

/// Gives back what is free inside of the allocator's own blocks.
void trim_allocator();

}  // namespace relook
