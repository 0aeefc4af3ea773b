// What lies where a cache is to be written, and which of it may go: a cache is known by its content, sound or not, and
// only files that write_cache() can have written are ever removed, by name. All else stays or moves along. Called by
// write_cache.cpp and staged_folder.h, and for the outputs of commands (cli/options/).
#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace relook {

/// What is at the path of an output.
struct Occupant {
  enum class Kind { none, cache, other };
  Kind kind = Kind::none;  // none: nothing, or a folder with nothing but what systems leave in folders
  std::string what;        // other: in words, "is a file", "holds plate.exr, which relook did not write"
  std::string foreign;     // cache: relative name of the first file that relook did not write, if there is one
};
/// Throws IoError for a folder that cannot be looked into.
[[nodiscard]] Occupant occupant_of(const std::filesystem::path& path);

/// The nearest of `path` itself and the folders above it that holds a cache. Links are followed, also to what is not
/// there yet.
[[nodiscard]] std::optional<std::filesystem::path> enclosing_cache(const std::filesystem::path& path);

/// Removes a cache's files from a folder, and the folder if nothing else is in it. Links are not followed.
void remove_cache_files(const std::filesystem::path& folder);

/// The same, where all else moves to another folder; what is called the same there stays.
void retire_cache(const std::filesystem::path& folder, const std::filesystem::path& heir);

}  // namespace relook
