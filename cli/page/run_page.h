// report.html of a run: what report.json and the journal say, and the frames themselves, for a browser. Made from the
// files of the run, one entry at a time, so that steps of an earlier run that were kept are in it, too, and that a long
// run takes no more memory than a short one. Never larger than kMostPageBytes. Called by cli/run/run_folder.h.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>

#include "base/json.h"
#include "edit/journal.h"
#include "report/report_entries.h"

namespace relook {

inline constexpr std::size_t kMostPageBytes = 5'000'000;  // of report.html

struct RunPageInput {
  const std::filesystem::path& folder;  // with the frames, previews and overlays that the entries name
  const Json& head;                     // as report.json without "steps" and "frames"
  const ReportEntries& entries;
  const Journal& journal;
  bool reads_pixels = true;     // false: a quick page that reads no frame and shows previews
  std::function<void()> check;  // called once an entry; may throw: the page is as before then. May be empty
};

/// Writes report.html and, when a run is too long for one file, pixels/*.js beside it (page/page_files.h). Throws
/// UsageError (something else has the name of such a file: found before anything is written), InputError (a frame is
/// missing or damaged), IoError, ResourceError.
void write_run_page(const RunPageInput& input);

}  // namespace relook
