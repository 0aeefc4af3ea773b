#include "base/system/large_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace relook {

void prefer_large_pages(const void* memory, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kPage = std::uintptr_t{1} << 21U;
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + kPage - 1) / kPage * kPage, last = (begin + bytes) / kPage * kPage;
  if (first >= last) return;
  void* const pages = reinterpret_cast<void*>(first);
  if (madvise(pages, last - first, MADV_HUGEPAGE) != 0) return;
#ifndef MADV_COLLAPSE
  constexpr int MADV_COLLAPSE = 25;  // Linux 6.1
#endif
  static_cast<void>(madvise(pages, last - first, MADV_COLLAPSE));
#else
  static_cast<void>(memory);
  static_cast<void>(bytes);
#endif
}

}  // namespace relook
