// The files that a cache consists of beside its manifest: one for each part, but of ray trees and tunnels one for each
// group of tiles. Which there are, what they are called, and their bytes; for reading (cache.cpp) and writing
// (write_cache.cpp).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cache/cache.h"
#include "cache/container.h"
#include "cache/manifest.h"

namespace relook {

enum class Part : std::uint8_t { look, geometry, textures, frame, paths, trees, tunnels };

struct PartFile {
  Part part = Part::look;
  std::size_t group = 0;  // of Part::trees and Part::tunnels
};

/// The files of a cache with this content: first the scene's, then the image's, then its tunnels'.
[[nodiscard]] std::vector<PartFile> parts_of(const CacheContent& content);

/// The start of a part's file name; the hash of its bytes follows (look.json has none, to be found by people).
[[nodiscard]] std::string stem(const PartFile& part);

/// The bytes of a part's file. Requires: not Part::tunnels, see encode_tunnels().
[[nodiscard]] Bytes encode(const PartFile& part, const CacheContent& content, const CacheIdentity& identity);

/// The manifest's entry of a part. Throws CacheDamage if there is none.
[[nodiscard]] const CacheFile& find_file(const Manifest& manifest, const PartFile& part);
/// What the tunnels of a group must be bound to: the hashes of the files of its ray trees and of the paths, 64 digits.
[[nodiscard]] std::string hashes_bound_to(const Manifest& manifest, std::size_t group);
inline constexpr std::string_view kOfOtherTrees = "the tunnels are of other ray trees";

}  // namespace relook
