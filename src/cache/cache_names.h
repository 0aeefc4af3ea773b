// Names in a cache's folder: those of its own files, which alone are ever removed.
#pragma once
#include <array>
#include <string_view>

namespace relook {

inline constexpr std::string_view kManifestName = "MANIFEST.json";
inline constexpr std::string_view kTreesFolder = "trees", kTunnelsFolder = "tunnels";
/// The folders in a cache's.
inline constexpr std::array<std::string_view, 2> kInnerFolders{kTreesFolder, kTunnelsFolder};

/// XXH3-128 in hexadecimal.
[[nodiscard]] bool is_hash(std::string_view text);

/// Of a file that a manifest may name, relative to the cache: "look.json", "trees/00000-<hash>.rlk".
[[nodiscard]] bool is_content_name(std::string_view name);

/// Of the manifest, of a file that it may name, or of one of these while it is being written (base/files.h).
[[nodiscard]] bool is_own_name(std::string_view name);

}  // namespace relook
