// libFuzzer's own mutations of bytes, for mutators of ours; nothing outside of its programs.
#pragma once
#include <cstddef>
#include <cstdint>

extern "C" __attribute__((weak)) std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace relook {

inline std::size_t libfuzzer_mutate(std::uint8_t* data, std::size_t size, std::size_t most) {
  return &LLVMFuzzerMutate != nullptr ? LLVMFuzzerMutate(data, size, most) : size;
}

}  // namespace relook
