// Which files relook has written: told by what stands in them, never by their names alone. Whatever this does not know
// is the user's. Asked before a file is replaced or removed, and before a report is believed to be one.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace relook {

enum class OwnKind : std::uint8_t {
  frame,       // OpenEXR with exactly the attributes that a frame has
  preview,     // PNG that names its writer in its first chunk
  page,        // HTML that names its generator
  page_data,   // script beside a page
  report,      // RUN/report.json
  progress,    // RUN/progress.jsonl
  comparison,  // `compare` --json
  plan,        // `plan` --json
  trace,       // --trace
  access_log,  // --access-log
  journal,     // written by `relook journal` and not changed since
  scene,       // written by `relook export` and not changed since
};
/// "a frame", for messages that go on with "of relook".
[[nodiscard]] std::string_view own_kind_name(OwnKind kind);

/// Whether `path` is a regular file of this kind that relook has written; false for what cannot be read.
[[nodiscard]] bool is_own_file(const std::filesystem::path& path, OwnKind kind);

}  // namespace relook
