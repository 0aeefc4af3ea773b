#include "base/system/memory.h"

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>

namespace relook {

std::uint64_t resident_set_bytes() {
  static std::atomic<int> kept = -1;  // stays open: opening takes longest
  int file = kept;
  if (file < 0) {
    const int opened = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (kept.compare_exchange_strong(file, opened))
      file = opened;
    else if (opened >= 0)
      ::close(opened);  // another thread's is kept
  }
  std::array<char, 128> text{};
  if (file < 0 || ::pread(file, text.data(), text.size() - 1, 0) <= 0) return 0;
  char* rest = nullptr;
  std::strtoull(text.data(), &rest, 10);  // the whole address space
  return std::strtoull(rest, nullptr, 10) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void trim_allocator() { malloc_trim(0); }

void give_back_large_blocks() {
  constexpr int kLarge = 128 << 10, kMostBlocks = 32 << 10;  // a process may map 65,530 by default
  mallopt(M_MMAP_THRESHOLD, kLarge);
  mallopt(M_MMAP_MAX, kMostBlocks);
}

}  // namespace relook
