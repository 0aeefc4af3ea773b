#pragma once
#include <filesystem>
#include <functional>
#include <optional>

#include "edit/journal.h"
#include "engine/report_entries.h"
namespace relook {
inline std::optional<std::filesystem::path> enclosing_cache(const std::filesystem::path& path) {
  for (std::filesystem::path at = path; at.has_relative_path(); at = at.parent_path())
    if (std::filesystem::exists(at / "MANIFEST.json")) return at;
  return std::nullopt;
}
struct RunPageInput {
  const std::filesystem::path& folder;
  const Json& head;
  const ReportEntries& entries;
  const Journal& journal;
  bool reads_pixels;
  std::function<void()> check;
};
inline void write_run_page(const RunPageInput&) {}
}  // namespace relook
