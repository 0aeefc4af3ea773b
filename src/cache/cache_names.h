// The names of the files in a cache's folder: nothing else in it is ever removed.
#pragma once
#include <array>
#include <string_view>

namespace relook {

inline constexpr std::string_view kManifestName = "MANIFEST.json";
inline constexpr std::string_view kTreesFolder = "trees", kTunnelsFolder = "tunnels";
/// The folders in a cache's folder.
inline constexpr std::array<std::string_view, 2> kInnerFolders{kTreesFolder, kTunnelsFolder};

/// Is it an XXH3-128 in hexadecimal?
[[nodiscard]] bool is_hash(std::string_view text);

/// May a manifest name such a file, relative to the cache? "look.json", "trees/00000-<hash>.rlk".
[[nodiscard]] bool is_content_name(std::string_view name);

/// Is it the name of the manifest, of a file that it may name, or of one of these while it is being written
/// (base/files.h)?
[[nodiscard]] bool is_own_name(std::string_view name);

}  // namespace relook
