// XXH3 of bytes and of files.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "base/files.h"

namespace relook {

[[nodiscard]] std::uint64_t hash64(BytesView bytes, std::uint64_t seed = 0);
/// XXH3-128 as 32 lower-case hexadecimal digits.
[[nodiscard]] std::string hash128(BytesView bytes);
/// The same of a regular file's bytes, which are never in memory together. Links are not followed. Throws InputError.
[[nodiscard]] std::string hash128_of_file(const std::filesystem::path& path);

}  // namespace relook
