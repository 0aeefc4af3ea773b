// A run's folder as `report`, `sheet` and index pages read it: from its own files alone. Names, values and notes are in
// report.json, edits in the headers of the frames; the journal and the cache need not be there.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "edit/journal.h"
#include "report/report_entries.h"
#include "report/run_ledger.h"

namespace relook {

/// The run at a path, or, where that is a folder of runs, as a replay of several journals makes it, all of these by
/// name. Throws InputError when there is none.
[[nodiscard]] std::vector<std::filesystem::path> runs_at(const std::filesystem::path& path);

class RunInput {
 public:
  /// Throws InputError when the run has no report of this version, or it is not as it was written.
  explicit RunInput(std::filesystem::path folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Of the journal: its file's name without extension, as the user wrote it then.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// report.json without "steps" and "frames".
  [[nodiscard]] const Json& head() const { return ledger_->head(); }
  /// Its entries in order, those of drags and wedges as a whole behind their frames. This must outlive it.
  [[nodiscard]] ReportEntries entries() const;
  /// The steps as far as frames say what led to them: a wedge as a drag. Reads a header a frame.
  [[nodiscard]] Journal journal() const;
  /// Stops, of its previews.
  [[nodiscard]] double exposure() const;
  /// DisplayView::id() of its previews; "": sRGB.
  [[nodiscard]] std::string view() const;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<RunLedger> ledger_;
  std::string name_;
  std::vector<RunLedger::Note> notes_;
};

}  // namespace relook
