#include "page/run_page.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "page/page.h"
#include "page/page_details.h"
#include "page/page_files.h"
#include "page/page_pixels.h"
#include "page/page_relight.h"
#include "page/run_entry.h"
#include "page/run_marks.h"
#include "page/view_lut.h"
#include "trace/tree/ray_tree.h"

namespace relook {
namespace {

constexpr std::size_t kOtherBytes = 800'000;                      // of scripts, styles and what stands around data
constexpr std::size_t kDataBytes = kMostPageBytes - kOtherBytes;  // of the page

/// What the data of a page may take, in bytes.
struct Room {
  std::size_t data = kDataBytes;
  std::size_t short_edits = kDataBytes / 3;  // rows beyond these have no edits in short
  std::size_t thumbnails = 1'000'000;        // of the data
};
constexpr std::size_t kAnyBytes = std::numeric_limits<std::size_t>::max() / 4;
constexpr Room kAnyRoom{kAnyBytes, kAnyBytes, kAnyBytes};

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
  /// `scale`: of a page of one file; none: of the run's own page.
  explicit RunPage(const RunPageInput& input, std::optional<std::uint32_t> scale = std::nullopt)
      : input_(input),
        scale_(scale),
        room_(scale ? kAnyRoom : Room()),
        files_(input.folder),
        pixels_(input.folder, exposure_of(input.head), files_, scale.value_or(1)),
        relight_(input.folder, input.journal, files_),
        details_(files_, (pixels_.frames_bytes() / 2 + kFreeBesideBytes) / 8),
        head_(shown_head(input.head)),
        view_(input.view && input.reads_pixels ? script_json(view_lut_json(*input.view)) : "null"),
        head_bytes_(script_json(head_).size() + view_.size()) {}

  void write() {
    take_all();
    const std::string text = page_text(page());
    check();
    write_file(input_.folder / "report.html", text);
    files_.keep_new();
  }
  [[nodiscard]] SinglePage single();

 private:
  void take_all() {
    for (std::size_t i = 0; i < input_.entries.count; ++i) {
      check();
      const Json entry = input_.entries.at(i);
      totals_.add(entry);
      if (!rows_are_full_) take(i, entry);
    }
    details_.end_chunk();
  }
  void check() const {
    if (input_.check) input_.check();
  }
  void take(std::size_t i, const Json& entry);
  [[nodiscard]] Json take_frame(std::size_t i, const std::string& stem);
  [[nodiscard]] bool has_taken_pixels(std::size_t i, const std::string& stem);
  [[nodiscard]] Json take_overlays(const std::string& stem);
  [[nodiscard]] std::size_t row_bytes() const { return head_bytes_ + rows_text_.size(); }
  void make_room();
  [[nodiscard]] Page page();

  const RunPageInput& input_;
  std::optional<std::uint32_t> scale_;
  Room room_;
  std::size_t previews_ = 0;  // entries of a page of one file without pixels
  PageFiles files_;
  PagePixels pixels_;
  PageRelight relight_;
  PageDetails details_;
  Pictures overlays_, thumbnails_;
  Json head_;
  std::string view_;  // JSON
  std::size_t head_bytes_;
  std::string rows_text_;
  std::size_t rows_ = 0;
  bool rows_are_full_ = false;
  Totals totals_;
};

void RunPage::take(std::size_t i, const Json& entry) {
  const std::string stem = stem_of(entry, i);
  const std::string row =
      (rows_ == 0 ? "" : ",\n") +
      script_json(row_of(entry, stem, marks_of(entry, input_.journal, rows_text_.size() < room_.short_edits)));
  const std::size_t places = pixels_.is_beside() ? pixels_.bytes_in_page() : 0;
  rows_are_full_ = row_bytes() + places + row.size() > room_.data;
  if (rows_are_full_) return;
  rows_text_ += row;
  ++rows_;
  if (details_.is_between_chunks()) details_.start_chunk(pixels_.sources());
  const Json kinds = take_overlays(stem);
  details_.add(details_of(entry, input_.journal, kinds), input_.reads_pixels ? take_frame(i, stem) : Json::object());
  if (input_.reads_pixels && !scale_) relight_.take(i, entry, stem);
  make_room();
}

/// Whether the frame could be read. In a page of one file its preview stands for one that could not.
bool RunPage::has_taken_pixels(std::size_t i, const std::string& stem) {
  const std::size_t others = row_bytes() + details_.bytes_in_page() + thumbnails_.bytes();
  const auto take = [&] {
    pixels_.take(i, stem, i + 1 == input_.entries.count, room_.data - std::min(others, room_.data));
  };
  if (!scale_) {
    take();
    return true;
  }
  try {
    take();
    return true;
  } catch (const InputError&) {
  } catch (const IoError&) {
  }
  ++previews_;
  const std::string preview = "previews/" + stem + ".png";
  std::error_code error;
  if (std::filesystem::is_regular_file(input_.folder / preview, error))
    thumbnails_.add(preview, read_file(input_.folder / preview));
  return false;
}

/// The tiles that the page has of a frame, and its thumbnail.
Json RunPage::take_frame(std::size_t i, const std::string& stem) {
  if (!has_taken_pixels(i, stem)) return Json::object();
  if (thumbnails_.is_open()) {
    thumbnails_.add("previews/" + stem + ".png", pixels_.thumbnail());
    if (thumbnails_.bytes() > room_.thumbnails) thumbnails_.leave_out();
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
           room_.data;
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
  if (scale_) head_["single"] = {{"scale", *scale_}, {"frames", rows_ - previews_}, {"previews", previews_}};
  Json layout = pixels_.finish();
  layout.update({{"tile", kTileSize}, {"chunk", kEntriesPerChunk}, {"page", files_.page_number()}});
  if (!input_.reads_pixels || rows_ == 0 || rows_ == previews_) {
    layout["width"] = head_.at("resolution").at(0);
    layout["height"] = head_.at("resolution").at(1);
  }
  const Json relight = relight_.finish();
  Json pictures = thumbnails_.urls();
  pictures.update(Json(overlays_.urls()));
  std::string columns = "[";
  for (const std::string_view column : row_columns())
    columns.append(columns.size() > 1 ? ",\"" : "\"").append(column).append("\"");

  Page page;
  page.title = "relook: " + input_.journal.name;
  page.styles = {"page.css", "viewer.css", "scopes.css", "report.css", "relight.css"};
  page.scripts = {"chart.min.js", "page.js",          "beside.js",  "pixels.js", "curves.js",   "display_gl.js",
                  "display.js",   "region.js",        "scopes.js",  "words.js",  "run_data.js", "viewer_input.js",
                  "viewer.js",    "pair_view.js",     "reviews.js", "wedge.js",  "card.js",     "tree.js",
                  "sheet.js",     "side.js",          "plots.js",   "link.js",   "keys.js",     "relight_layers.js",
                  "relight.js",   "relight_panel.js", "report.js"};
  std::error_code error;
  const bool is_live =  // `watch` goes on with it
      !scale_ && std::filesystem::exists(input_.folder / "relook_live.js", error);
  if (is_live) page.scripts.emplace_back("live.js");
  page.body = with_viewer(asset_text("report.html"));
  page.has_files_beside = is_live || pixels_.is_beside() || details_.is_beside() || !relight.is_null();
  page.data = {
      {"report", script_json(head_)},  {"rows", "{\"columns\":" + columns + "],\"rows\":[" + rows_text_ + "]}"},
      {"details", details_.in_page()}, {"pictures", script_json(pictures)},
      {"layout", script_json(layout)}, {"pixels", pixels_.in_page()},
      {"display-view", view_},         {"relight-data", script_json(relight)}};
  return page;
}

SinglePage RunPage::single() {
  take_all();
  SinglePage single;
  single.page = page();
  single.frames = rows_ - previews_;
  single.previews = previews_;
  for (const auto& [id, value] : single.page.data) {
    SinglePage::Bytes& bytes = single.bytes;
    (id == "pictures" ? bytes.previews : id == "pixels" ? bytes.pixels : bytes.data) += value.size();
  }
  single.bytes.viewer = frame_bytes(single.page);
  return single;
}

}  // namespace

SinglePage single_run_page(const RunPageInput& input, std::uint32_t scale) { return RunPage(input, scale).single(); }

std::string run_link(std::size_t run) { return "?run=" + std::to_string(run + 1); }

SinglePage joined_pages(std::vector<SinglePage> pages, const std::vector<RunCard>& cards) {
  SinglePage joined = std::move(pages.front());
  Page& all = joined.page;
  all.title = "relook: " + std::to_string(pages.size()) + " runs";
  all.styles.push_back("index.css");
  all.body = "<div id=\"runs\" data-runs=\"" + std::to_string(pages.size()) + "\"><main>\n<h1>" +
             std::to_string(pages.size()) + " runs</h1>\n" + cards_html(cards) +
             "</main></div>\n<div id=\"one-run\" hidden>\n" + all.body + "</div>\n";
  std::vector<std::pair<std::string, std::string>> data;
  for (std::size_t run = 0; run < pages.size(); ++run) {
    SinglePage& page = run == 0 ? joined : pages[run];
    for (auto& [id, value] : page.page.data) data.emplace_back(id + "-" + std::to_string(run + 1), std::move(value));
    if (run == 0) continue;
    joined.frames += page.frames;
    joined.previews += page.previews;
    joined.bytes.previews += page.bytes.previews;
    joined.bytes.pixels += page.bytes.pixels;
    joined.bytes.data += page.bytes.data;
  }
  all.data = std::move(data);
  joined.bytes.viewer = frame_bytes(all);
  return joined;
}

void write_run_page(const RunPageInput& input) { RunPage(input).write(); }

}  // namespace relook
