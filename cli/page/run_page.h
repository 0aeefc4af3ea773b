// report.html of a run: what report.json and the journal say, and the frames themselves, for a browser. Made from the
// files of the run, one entry at a time, so that steps of an earlier run that were kept are in it, too, and that a long
// run takes no more memory than a short one. Never larger than kMostPageBytes. Called by cli/run/run_folder.h.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>

#include "base/json.h"
#include "edit/journal.h"
#include "frame/display_view.h"
#include "page/index_page.h"
#include "page/page.h"
#include "report/report_entries.h"

namespace relook {

inline constexpr std::size_t kMostPageBytes = 5'000'000;  // of report.html

struct RunPageInput {
  const std::filesystem::path& folder;  // with the frames, previews and overlays that the entries name
  const Json& head;                     // as report.json without "steps" and "frames"
  const ReportEntries& entries;
  const Journal& journal;
  bool reads_pixels = true;     // false: a quick page that reads no frame and shows previews
  std::function<void()> check{};  // called once an entry; may throw: the page is as before then. May be empty
  std::shared_ptr<const DisplayView> view = {};  // of the previews; null: sRGB
};

/// Writes report.html and, when a run is too long for one file, pixels/*.js beside it (page/page_files.h). Throws
/// UsageError (something else has the name of such a file: found before anything is written), InputError (a frame is
/// missing or damaged), IoError, ResourceError.
void write_run_page(const RunPageInput& input);

/// A page of one file, to send: all rows, details and pixels, whatever they take, and previews of frames whose files
/// are missing or damaged.
struct SinglePage {
  Page page;
  std::size_t frames = 0, previews = 0;  // entries with linear pixels; entries shown by their previews alone
  struct Bytes {
    std::size_t previews = 0, pixels = 0, data = 0, viewer = 0;
    [[nodiscard]] std::size_t total() const { return previews + pixels + data + viewer; }
  } bytes;
};
/// `scale`: pixels are at 1/scale of the frames' size. Throws InputError, IoError.
[[nodiscard]] SinglePage single_run_page(const RunPageInput& input, std::uint32_t scale);
/// Pages of several runs as one, which begins with their cards; their links are run_link()s.
[[nodiscard]] SinglePage joined_pages(std::vector<SinglePage> pages, const std::vector<RunCard>& cards);
[[nodiscard]] std::string run_link(std::size_t run);

}  // namespace relook
