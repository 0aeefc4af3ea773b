#include "base/system/memory.h"

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

namespace relook {
namespace {

/// The number in a file, if it begins with one ("max" is none).
std::uint64_t number_in(const std::string& file) {
  std::ifstream stream(file);
  std::uint64_t number = 0;
  return stream >> number ? number : std::numeric_limits<std::uint64_t>::max();
}

/// The least limit of a control group and those above it. `path`: of the group, "/a/b".
std::uint64_t least_limit(const std::string& root, std::string path, const char* file) {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  while (true) {
    least = std::min(least, number_in(root + path + "/" + file));
    if (path.empty()) return least;
    path.resize(path.find_last_of('/') == std::string::npos ? 0 : path.find_last_of('/'));
  }
}

}  // namespace

std::uint64_t machine_memory_bytes() {
  static const std::uint64_t bytes = [] {
    auto least =
        static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    std::ifstream groups("/proc/self/cgroup");  // "0::/path", of version 1 "7:memory:/path"
    for (std::string line; std::getline(groups, line);) {
      const std::size_t first = line.find(':'), second = line.find(':', first + 1);
      if (first == std::string::npos || second == std::string::npos) continue;
      const std::string names = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
      if (names.empty()) least = std::min(least, least_limit("/sys/fs/cgroup", path, "memory.max"));
      if (names == "memory")
        least = std::min(least, least_limit("/sys/fs/cgroup/memory", path, "memory.limit_in_bytes"));
    }
    return least;
  }();
  return bytes;
}

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
