// The files that a cache consists of, beside its manifest: one a part, but of ray trees one a group of tiles.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cache/cache.h"
#include "cache/container.h"

namespace relook {

enum class Part : std::uint8_t { look, geometry, textures, frame, paths, trees };
constexpr std::array<std::string_view, 6> kPartNames{"look.json", "geometry", "textures", "frame", "paths", "trees"};

struct PartFile {
  Part part = Part::look;
  std::size_t group = 0;  // of Part::trees
};

/// In this order: the scene comes first, then the image.
[[nodiscard]] std::vector<PartFile> parts_of(const CacheContent& content);

/// The start of a part's file name; the hash of its bytes follows (look.json has none, to be found by people).
[[nodiscard]] std::string stem(const PartFile& part);

/// The bytes of its file.
[[nodiscard]] Bytes encode(const PartFile& part, const CacheContent& content, const CacheIdentity& identity);

}  // namespace relook
