// A page over several runs: a card a run, with its first and last picture, what it holds, and a link to its own page.
// No script, no other file: pictures stand in the page. Written by `replay` of several journals and by `report`.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/json.h"
#include "report/report_entries.h"

namespace relook {

inline constexpr std::string_view kIndexName = "index.html";

/// What a card says of a run.
struct RunCard {
  std::string name;    // any text
  std::string link;    // URL of its page, relative
  std::string report;  // URL of its report.json, relative; "": none
  std::string facts;   // scene, camera, size: any text
  std::string note;    // of its journal
  std::size_t steps = 0, frames = 0;
  std::map<std::string, std::size_t> classes;  // steps by class
  std::size_t verified_frames = 0;
  std::uint64_t pixels_different = 0;  // of verified frames
  bool is_interrupted = false;
  struct Picture {
    std::string url, text;
  };
  std::vector<Picture> pictures;  // first and last
};

/// The card of a run, without its links. Reads two frames. `exposure`: stops, of its pictures.
[[nodiscard]] RunCard run_card(const std::filesystem::path& run, const std::string& name, const Json& head,
                               const ReportEntries& entries, double exposure);

/// A path from a page to a file, as a URL: relative where it can be.
[[nodiscard]] std::string relative_url(const std::filesystem::path& page, const std::filesystem::path& file);

/// The cards as HTML.
[[nodiscard]] std::string cards_html(const std::vector<RunCard>& cards);
/// The text of the page.
[[nodiscard]] std::string index_text(const std::string& title, const std::vector<RunCard>& cards);

}  // namespace relook
