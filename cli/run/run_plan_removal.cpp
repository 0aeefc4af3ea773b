// What a plan removes from its run folder: only files that relook has written, and never beyond a link.
#include <set>

#include "run/run_files.h"
#include "run/run_plan.h"

namespace relook {

/// Removes files that relook has written: frames of no step of this journal, or all files of another run. Requires: all
/// steps are locked.
void RunPlan::remove_replaced() const {
  std::set<std::string> stems;  // of frames that stay
  if (!replaces_all_)
    for (const auto& [key, note] : ledger_->notes())
      if (is_of_journal(key, note)) stems.insert(std::filesystem::path(frame_name_of(key)).stem().string());
  for (const RunPart& part : kRunParts) {
    if (part.folder == "pixels" && !replaces_all_) continue;  // the page sees to its own
    const std::filesystem::path folder = folder_ / part.folder;
    for (const std::filesystem::path& file : entries_not_beyond_link(folder)) {
      const std::string unfinished = unfinished_name(file),
                        name = unfinished.empty() ? file.filename().string() : unfinished;
      if (!replaces_all_ && (!is_frame_stem(name) || stems.contains(frame_stem(name)))) continue;
      if (!unfinished.empty() || is_own_file(file, part.kind)) remove_file(file);
    }
    std::error_code not_empty;
    const bool is_folder =
        std::filesystem::symlink_status(folder, not_empty).type() == std::filesystem::file_type::directory;
    if (is_folder) std::filesystem::remove(folder, not_empty);
  }
  for (const std::string_view name : {kReportName, std::string_view("report.html")})
    if (is_there(folder_ / name)) remove_file(folder_ / name);
}

void RunPlan::remove_unfinished_page() const {
  for (const std::filesystem::path& file : entries_of(folder_))
    if (unfinished_name(file) == "report.html") remove_file(file);
}

/// Removes temporary files of commands that were killed at the steps that are locked now, or while they wrote
/// report.json.
void RunPlan::remove_leftovers() const {
  for (const RunPart& part : kRunParts)
    for (const std::filesystem::path& file : entries_not_beyond_link(folder_ / part.folder)) {
      const std::string name = unfinished_name(file);
      const bool is_ours =
          part.folder != "pixels" && is_frame_stem(name) && step_of(name) >= first_ && step_of(name) <= last_;
      if (is_ours) remove_file(file);
    }
  for (const std::filesystem::path& file : entries_of(folder_))
    if (unfinished_name(file) == kReportName) remove_file(file);
}

}  // namespace relook
