#include "page/run_page.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "base/files.h"
#include "frame/display_view.h"
#include "page/page.h"
#include "page/page_details.h"
#include "page/page_files.h"
#include "page/page_pixels.h"
#include "page/run_entry.h"
#include "trace/tree/ray_tree.h"

namespace relook {
namespace {

constexpr std::size_t kOtherBytes = 800'000;                      // of scripts, styles and what stands around data
constexpr std::size_t kDataBytes = kMostPageBytes - kOtherBytes;  // of the page
constexpr std::size_t kThumbnailBytes = 1'000'000;  // of the data, for thumbnails

/// What a page says of all entries, those included that it has no rows for.
struct Totals {
  double seconds = 0;
  std::uint64_t verified_frames = 0, pixels_different = 0;

  void add(const Json& entry) {
    const Json::json_pointer total("/seconds/total");
    if (entry.contains(total) && entry[total].is_number()) seconds += entry[total].get<double>();
    const auto verify = entry.find("verify");
    if (verify == entry.end() || !verify->is_object()) return;
    ++verified_frames;
    if (const auto different = verify->find("pixels_different"); different != verify->end() && different->is_number())
      pixels_different += different->get<std::uint64_t>();
  }
};

/// Images that stand in the page, by the name of their file.
class Pictures {
 public:
  void add(const std::string& name, BytesView png) {
    const auto [place, is_new] = urls_.emplace(name, png_url(png));
    if (is_new) bytes_ += place->second.size() + name.size() + 6;
  }
  /// From here on the page names their files and has none of them.
  void leave_out() {
    is_open_ = false;
    urls_.clear();
    bytes_ = 0;
  }
  [[nodiscard]] bool is_open() const { return is_open_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] const std::map<std::string, std::string>& urls() const { return urls_; }

 private:
  std::map<std::string, std::string> urls_;
  std::size_t bytes_ = 0;
  bool is_open_ = true;
};

double exposure_of(const Json& head) {
  const Json* value = head.contains("options") ? &head.at("options") : nullptr;
  if (value == nullptr || !value->is_object() || !value->contains("exposure")) return 0;
  value = &value->at("exposure");
  return value->is_number() ? std::clamp(value->get<double>(), -kMostExposure, kMostExposure) : 0;
}

/// Goes through the entries once. What the page has no room for leaves it in this order: overlays, pixels, thumbnails,
/// details. Rows never leave; once there is no room for a row, it and all later entries have none.
class RunPage {
 public:
  explicit RunPage(const RunPageInput& input)
      : input_(input),
        files_(input.folder),
        pixels_(input.folder, exposure_of(input.head), files_),
        details_(files_, (pixels_.frames_bytes() / 2 + kFreeBesideBytes) / 8),
        head_(shown_head(input.head)),
        head_bytes_(script_json(head_).size()) {}

  void write() {
    for (std::size_t i = 0; i < input_.entries.count; ++i) {
      check();
      const Json entry = input_.entries.at(i);
      totals_.add(entry);
      if (!rows_are_full_) take(i, entry);
    }
    details_.end_chunk();
    const std::string text = page_text(page());
    check();
    write_file(input_.folder / "report.html", text);
    files_.keep_new();
  }

 private:
  void check() const {
    if (input_.check) input_.check();
  }
  void take(std::size_t i, const Json& entry);
  [[nodiscard]] Json take_frame(std::size_t i, const std::string& stem);
  [[nodiscard]] Json take_overlays(const std::string& stem);
  [[nodiscard]] std::size_t row_bytes() const { return head_bytes_ + rows_text_.size(); }
  void make_room();
  [[nodiscard]] Page page();

  const RunPageInput& input_;
  PageFiles files_;
  PagePixels pixels_;
  PageDetails details_;
  Pictures overlays_, thumbnails_;
  Json head_;
  std::size_t head_bytes_;
  std::string rows_text_;
  std::size_t rows_ = 0;
  bool rows_are_full_ = false;
  Totals totals_;
};

void RunPage::take(std::size_t i, const Json& entry) {
  const std::string stem = stem_of(entry, i);
  const std::string row = (rows_ == 0 ? "" : ",\n") + script_json(row_of(entry, stem));
  const std::size_t places = pixels_.is_beside() ? pixels_.bytes_in_page() : 0;
  rows_are_full_ = row_bytes() + places + row.size() > kDataBytes;
  if (rows_are_full_) return;
  rows_text_ += row;
  ++rows_;
  if (details_.is_between_chunks()) details_.start_chunk(pixels_.sources());
  const Json kinds = take_overlays(stem);
  details_.add(details_of(entry, input_.journal, kinds), input_.reads_pixels ? take_frame(i, stem) : Json::object());
  make_room();
}

/// The tiles that the page has of a frame, and its thumbnail.
Json RunPage::take_frame(std::size_t i, const std::string& stem) {
  const std::size_t others = row_bytes() + details_.bytes_in_page() + thumbnails_.bytes();
  pixels_.take(i, stem, i + 1 == input_.entries.count, kDataBytes - std::min(others, kDataBytes));
  if (thumbnails_.is_open()) {
    thumbnails_.add("previews/" + stem + ".png", pixels_.thumbnail());
    if (thumbnails_.bytes() > kThumbnailBytes) thumbnails_.leave_out();
  }
  return pixels_.has_last() ? Json{{"tiles", pixels_.last_tiles()}} : Json::object();
}

/// The kinds of overlays that a frame has: "touched" is "overlays/0003_touched.png".
Json RunPage::take_overlays(const std::string& stem) {
  Json kinds = Json::array();
  for (const char* kind : {"dependent", "touched", "groups"}) {
    const std::string name = "overlays/" + stem + "_" + kind + ".png";
    std::error_code error;
    if (!std::filesystem::is_regular_file(input_.folder / name, error)) continue;
    kinds.push_back(kind);
    if (overlays_.is_open()) overlays_.add(name, read_file(input_.folder / name));
  }
  return kinds;
}

void RunPage::make_room() {
  const auto is_over = [&] {
    return row_bytes() + details_.bytes_in_page() + pixels_.bytes_in_page() + overlays_.bytes() + thumbnails_.bytes() >
           kDataBytes;
  };
  if (is_over()) overlays_.leave_out();
  if (is_over() && !pixels_.is_beside()) pixels_.move_out();
  if (is_over()) thumbnails_.leave_out();
  if (is_over() && !details_.is_beside()) details_.move_out();
}

Page RunPage::page() {
  head_["entries"] = input_.entries.count;
  head_["rows"] = rows_;
  head_["seconds"] = totals_.seconds;
  head_["verified"] = {{"frames", totals_.verified_frames}, {"pixels_different", totals_.pixels_different}};
  Json layout = pixels_.finish();
  layout.update({{"tile", kTileSize}, {"chunk", kEntriesPerChunk}, {"page", files_.page_number()}});
  if (!input_.reads_pixels || rows_ == 0) {
    layout["width"] = head_.at("resolution").at(0);
    layout["height"] = head_.at("resolution").at(1);
  }
  Json pictures = thumbnails_.urls();
  pictures.update(Json(overlays_.urls()));
  std::string columns = "[";
  for (const std::string_view column : row_columns())
    columns.append(columns.size() > 1 ? ",\"" : "\"").append(column).append("\"");

  Page page;
  page.title = "relook: " + input_.journal.name;
  page.styles = {"page.css", "report.css"};
  page.scripts = {"chart.min.js", "page.js", "beside.js", "pixels.js", "viewer.js", "plots.js",
                  "words.js",     "keys.js", "sheet.js",  "side.js",   "report.js"};
  page.body = asset_text("report.html");
  page.has_files_beside = pixels_.is_beside() || details_.is_beside();
  page.data = {
      {"report", script_json(head_)},  {"rows", "{\"columns\":" + columns + "],\"rows\":[" + rows_text_ + "]}"},
      {"details", details_.in_page()}, {"pictures", script_json(pictures)},
      {"layout", script_json(layout)}, {"pixels", pixels_.in_page()}};
  return page;
}

}  // namespace

void write_run_page(const RunPageInput& input) { RunPage(input).write(); }

}  // namespace relook
