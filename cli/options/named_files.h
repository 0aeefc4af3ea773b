// The files and folders that a command line names, with what each is for: the one list that says what is kept from
// being overwritten (outputs.h) and what the sandbox leaves within reach (reach.h).
#pragma once
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "options/arguments.h"
#include "report/own_file.h"

namespace relook {

struct NamedOutput {
  std::filesystem::path path;
  std::string_view option;
  std::optional<OwnKind> kind;  // none: a folder
};
struct NamedInput {
  std::filesystem::path path;
  std::string_view what;
};

/// Throws UsageError when `render` is to write neither a frame nor a preview.
[[nodiscard]] std::vector<NamedOutput> outputs_of(const Arguments& arguments);
/// The inputs that the command line names, without standard input.
[[nodiscard]] std::vector<NamedInput> inputs_of(const Arguments& arguments);

/// Whether `render` is to write a preview (.png), not a frame (.exr). Throws UsageError for any other suffix.
[[nodiscard]] bool is_preview_name(const std::filesystem::path& output);

/// The journal that `watch` keeps beside a run: RUN.json.
[[nodiscard]] std::filesystem::path journal_beside(const std::filesystem::path& run);

/// Whether `export` is to write a .glb, not a .gltf. Throws UsageError for any other suffix.
[[nodiscard]] bool is_binary_scene_name(const std::filesystem::path& output);

}  // namespace relook
