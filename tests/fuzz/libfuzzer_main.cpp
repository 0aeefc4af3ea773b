// What libFuzzer calls: the target whose name the program is built with.
#include <cstring>

#include "fuzz_targets.h"
#include "libfuzzer_mutate.h"

namespace {

const relook::FuzzTarget& target() {
  static const relook::FuzzTarget* const found = [] {
    const relook::FuzzTarget* match = nullptr;
    for (const relook::FuzzTarget& each : relook::kFuzzTargets)
      if (std::strcmp(each.name, RELOOK_FUZZ_TARGET) == 0) match = &each;
    return match;
  }();
  return *found;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { return target().run(data, size); }

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  if (target().mutate == nullptr) return LLVMFuzzerMutate(data, size, most);
  return target().mutate(data, size, most, seed);
}
