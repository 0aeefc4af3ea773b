// The index page of several runs: RUN/index.html of a replay of several journals, or wherever `report` is to write it.
#pragma once
#include <filesystem>
#include <vector>

namespace relook {

/// Writes an index of these runs, with links relative to the page. Throws InputError when one has no report.
void write_index(const std::filesystem::path& page, const std::vector<std::filesystem::path>& runs);

/// Throws UsageError when the index in a folder of runs is to go where something else is.
void require_free_index(const std::filesystem::path& folder);

/// Whether a command is at a run that has progress.jsonl.
[[nodiscard]] bool is_being_written(const std::filesystem::path& run);

}  // namespace relook
