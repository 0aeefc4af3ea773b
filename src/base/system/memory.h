// Memory of this process: how much the operating system counts, and ways to give memory back or to keep it.
#pragma once
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace relook {

/// The bytes of the resident set now. Not for a child of fork(): it would be told of the process that asked first.
[[nodiscard]] std::uint64_t resident_set_bytes();

/// What this process may use at most: the machine's memory, or less where its control groups say so.
[[nodiscard]] std::uint64_t machine_memory_bytes();

/// Keeps a value until the process ends, and its memory with it: for what would take long to take apart for nothing.
template <class T>
void keep_to_the_end(T value) {
  static std::vector<std::unique_ptr<T>>& kept = *new std::vector<std::unique_ptr<T>>();  // never destroyed
  kept.push_back(std::make_unique<T>(std::move(value)));
}

/// Empties a vector and gives its memory back: `vector = {}` keeps it.
template <class T>
void give_back(std::vector<T>& vector) {
  std::vector<T>().swap(vector);
}

/// Gives back what is free inside of the allocator's own blocks.
void trim_allocator();

/// From now on blocks of 128 KiB and more go back to the system as they are freed. By itself glibc keeps ever larger
/// ones (up to 32 MiB) inside of its own, where what is left around them is lost.
void give_back_large_blocks();

}  // namespace relook
