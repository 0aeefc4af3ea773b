// Large tables that are read at random places: with pages of 2 MiB the processor finds where they are.
#pragma once
#include <cstddef>
#include <vector>

namespace relook {

/// Asks the system to lay memory that holds something out in large pages, as far as it covers them. Nothing if it cannot.
void prefer_large_pages(const void* memory, std::size_t bytes);

template <class T>
void prefer_large_pages(const std::vector<T>& table) {
  prefer_large_pages(table.data(), table.size() * sizeof(T));
}

}  // namespace relook
