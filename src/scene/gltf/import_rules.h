// How lenient imports are and where files may lie: one rule of the process, as its import memory is, for scenes, for
// models and images that journals name, and for caches.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace relook {

struct ImportRules {
  bool is_strict = false;                    // --strict-gltf: what would be repaired or ignored is refused
  std::vector<std::filesystem::path> roots;  // --root: files below them may be named by scenes and journals
};

/// To be called while nothing is read.
void set_import_rules(ImportRules rules);
[[nodiscard]] const ImportRules& import_rules();

/// contained_path() under the rules: below `folder` or one of the roots.
[[nodiscard]] std::filesystem::path allowed_path(const std::filesystem::path& folder, std::string_view uri,
                                                 std::string_view file, std::string_view where);

/// Something against the specification that has one plain meaning, or that nothing uses: a warning
/// "WHERE: WHAT". Throws InputError{file, where, what} where imports are strict.
void tolerate(std::string_view file, std::string_view where, std::string_view what,
              std::vector<std::string>& warnings);

}  // namespace relook
