// Counts what Embree is asked for, whatever the program says that it asks: the linker leads its calls here first
// (CMakeLists.txt, --wrap).
#pragma once
#include <cstdint>

namespace relook {

struct EmbreeCalls {
  std::uint64_t rays = 0, shadows = 0;  // against top levels of more than one object
  std::uint64_t tests = 0;              // different rays and segments against those of one object, of the same device
  std::uint64_t objects = 0;            // calls of devices that have no level of more than one object
};

/// Counts from its beginning to take(). One at a time.
class EmbreeCallCounter {
 public:
  EmbreeCallCounter();
  ~EmbreeCallCounter();
  EmbreeCallCounter(const EmbreeCallCounter&) = delete;
  EmbreeCallCounter& operator=(const EmbreeCallCounter&) = delete;
  /// Since the last call. Top levels that were built before this counter began are not known.
  [[nodiscard]] EmbreeCalls take();
};

}  // namespace relook
