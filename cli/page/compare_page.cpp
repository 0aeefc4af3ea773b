#include "page/compare_page.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/tiles.h"
#include "compare_text.h"
#include "frame/frame_tiles.h"
#include "page/page.h"
#include "report/report.h"

namespace relook {
namespace {

std::string html(std::string_view text) { return escaped_html(printable(text)); }

std::string number(double value) { return short_number(value); }

std::string number(const std::optional<double>& value) { return value ? number(*value) : "\u2013"; }

std::string cell(std::string_view text, const char* kind = "") {
  return std::string(*kind == 0 ? "<td>" : "<td class=\"" + std::string(kind) + "\">") + html(text) + "</td>";
}

std::string head(std::string_view text) { return "<th class=\"name\">" + html(text) + "</th>"; }

std::string frame_row(const std::string& name, const FrameComparison& comparison) {
  const FrameDifference& difference = comparison.difference;
  const std::string verdict(verdict_name(comparison.verdict));
  std::string row = "<tr>" + head(name) + cell(verdict, verdict.c_str()) +
                    cell(std::to_string(difference.pixels_different)) + cell(number(difference.max_error)) +
                    cell(number(difference.rms_error)) + cell(number(comparison.psnr)) + cell(number(comparison.ssim));
  std::optional<double> mean, largest;
  if (comparison.has_picture && !comparison.worst) mean = largest = 0;
  if (comparison.flip) mean = comparison.flip->mean, largest = comparison.flip->largest;
  row += cell(number(mean)) + cell(number(largest));
  std::string place;
  if (const auto& worst = comparison.worst) {
    place = std::to_string(worst->x) + "," + std::to_string(worst->y) + ":";
    for (const Rgba* pixel : {&worst->a, &worst->b}) {
      if (pixel == &worst->b) place += " and";
      for (const float value : {pixel->r, pixel->g, pixel->b, pixel->a}) place += " " + number(double{value});
    }
  }
  return row + cell(place, "name") + "</tr>\n";
}

std::string layer_row(const std::string& name, const LayerDifference& layer) {
  const std::string verdict(verdict_name(layer.verdict));
  std::optional<double> max_error, rms_error;
  if (layer.has_quantities) max_error = layer.figures.max_error, rms_error = layer.rms_error;
  return "<tr>" + head(name) + cell(layer.part, "name") + cell(layer.level) + cell(layer.layer, "name") +
         cell(verdict, verdict.c_str()) + cell(std::to_string(layer.figures.pixels_different)) +
         cell(number(max_error)) + cell(number(rms_error)) + cell(std::to_string(layer.pixels_other_ids)) +
         cell(first_difference(layer), "name") + "</tr>\n";
}

/// Rows for the layers that differ; what is equal is only counted.
std::string layer_table(const PairComparison& pair) {
  std::string rows;
  std::size_t equal = 0;
  for (const auto& [name, comparison] : pair.frames) {
    for (const LayerDifference& layer : comparison.layers) {
      if (layer.verdict == Verdict::equal)
        ++equal;
      else
        rows += layer_row(name, layer);
    }
  }
  const std::string count = "<p>Equal layers, of all parts of all frames: " + std::to_string(equal) + "</p>\n";
  if (rows.empty()) return count;
  std::string heads;
  for (const char* name : {"frame", "part", "level", "layer", "verdict", "pixels different", "max error", "RMS error",
                           "pixels with other ids", "first difference"})
    heads += head(name);
  return "<h3>Layers that differ</h3>\n<table>\n<tr>" + heads + "</tr>\n" + rows + "</table>\n" + count;
}

/// The tiles of a frame as RunFrames in pixels.js has them, in one record: [tiles, sizes, base64].
Json record_of(const FrameTiles& tiles) {
  Json sizes = Json::array();
  Bytes all;
  for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
    const BytesView packed = tiles.packed(tile);
    sizes.push_back(packed.size());
    all.insert(all.end(), packed.begin(), packed.end());
  }
  return {tiles.count(), std::move(sizes), base64(all)};
}

Json layout_of(const FrameTiles& tiles) {
  Json channels = Json::array();
  for (const FrameTiles::Channel& channel : tiles.channels())
    channels.push_back({{"name", channel.name}, {"bytes", channel.bytes}});
  return {{"width", tiles.width()},
          {"height", tiles.height()},
          {"tile", kTileSize},
          {"channels", std::move(channels)},
          {"bundles", nullptr}};
}

/// Of a frame without pixels in the page.
Json layout_of(const Pictures& pictures) {
  Json channels = Json::array();
  for (const char* name : {"A", "B", "G", "R"}) channels.push_back({{"name", name}, {"bytes", 2}});
  return {{"width", pictures.width},
          {"height", pictures.height},
          {"tile", kTileSize},
          {"channels", std::move(channels)},
          {"bundles", nullptr}};
}

Json facts_of(const FrameComparison& comparison, DisplayWhite white) {
  Json facts = Json::array();
  const auto add = [&](const std::string& name, const std::string& value) { facts.push_back({name, value}); };
  add("verdict", std::string(verdict_name(comparison.verdict)));
  add("pixels different", std::to_string(comparison.difference.pixels_different));
  add("max error", number(comparison.difference.max_error));
  add("RMS error", number(comparison.difference.rms_error));
  add("PSNR (dB, peak " + number(white.value) + ")", number(comparison.psnr));
  add("SSIM", number(comparison.ssim));
  if (comparison.flip) {
    add("FLIP, mean", number(comparison.flip->mean));
    add("FLIP, largest", number(comparison.flip->largest));
  }
  if (const auto& worst = comparison.worst)
    add("worst pixel", std::to_string(worst->x) + ", " + std::to_string(worst->y));
  return facts;
}

std::string column_head(const RunTable::Column& column) {
  std::string text = column.run;
  for (const auto& [name, value] : column.settings) text += ", " + name + " " + value;
  if (column.full_render_seconds) text += ", full render " + number(*column.full_render_seconds) + " s";
  return "<th>" + html(text) + "</th>";
}

std::string measure_table(const RunTable& table, std::size_t measure) {
  std::string text = "<table>\n<tr>" + head("step") + head("name") + head("class");
  for (const RunTable::Column& column : table.columns) text += column_head(column);
  text += "</tr>\n";
  for (const RunTable::Row& row : table.rows) {
    text += "<tr>" + head(row.label) + cell(row.name, "name") + cell(row.change_class, "name");
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const bool has_value = i < row.values.size() && row.values[i];
      const double value = has_value ? (*row.values[i])[measure] : 0;
      const std::string shown =
          kMeasures[measure].is_time ? number(value) : std::to_string(static_cast<std::uint64_t>(value));
      text += cell(has_value ? shown : "\u2013");
    }
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

}  // namespace

void ComparePage::add_pair(const std::string& b, const PairComparison& pair) {
  pairs_ += "<h2>" + html(a_) + " and " + html(b) + ": " + html(verdict_name(pair.verdict)) + "</h2>\n<table>\n<tr>";
  const std::string psnr_name = "PSNR (dB, peak " + number(white_.value) + ")";
  for (const char* name : {"frame", "verdict", "pixels different", "max error", "RMS error", psnr_name.c_str(), "SSIM",
                           "FLIP, mean", "FLIP, largest", "worst pixel: channels of both"})
    pairs_ += head(name);
  pairs_ += "</tr>\n";
  for (const auto& [name, comparison] : pair.frames) pairs_ += frame_row(name, comparison);
  for (const std::string& name : pair.missing)
    pairs_ += "<tr>" + head(name) + cell("in one only", "failure") + "</tr>\n";
  pairs_ += "</table>\n" + layer_table(pair);
  for (const auto& [name, comparison] : pair.frames)
    if (const auto found = pair.pictures.find(name); found != pair.pictures.end())
      add_frame(b, name, comparison, found->second);
}

void ComparePage::add_frame(const std::string& b, const std::string& name, const FrameComparison& comparison,
                            const Pictures& pictures) {
  const std::string file = std::filesystem::path(b).filename().string();
  Json frame{{"title", printable(name == file ? name : name + ", " + file)},
             {"names", {printable(a_), printable(b)}},
             {"verdict", verdict_name(comparison.verdict)},
             {"facts", facts_of(comparison, white_)},
             {"previews", {png_url(pictures.a), png_url(pictures.b)}},
             {"errors", png_url(pictures.errors)},
             {"pixels", nullptr}};
  if (pictures.pixels_a.empty()) {
    frame["layout"] = layout_of(pictures);
  } else {
    const FrameTiles first(Bytes(pictures.pixels_a), name), second(Bytes(pictures.pixels_b), name);
    frame["layout"] = layout_of(first);
    frame["pixels"] = {record_of(first), record_of(second)};
  }
  frames_.emplace_back(pictures.badness, script_json(frame));
}

void ComparePage::set_runs(const RunTable& table) {
  runs_ = "<h2>Runs side by side</h2>\n";
  std::string same;
  for (std::size_t measure = 0; measure < kMeasures.size(); ++measure) {
    const std::string name(kMeasures[measure].name);
    if (!kMeasures[measure].is_time && table.is_same(measure))
      same += (same.empty() ? "" : ", ") + name;
    else
      runs_ += "<h3>" + html(name) + (kMeasures[measure].is_time && measure > 0 ? ", seconds" : "") + "</h3>\n" +
               measure_table(table, measure);
  }
  if (!same.empty()) runs_ += "<p>The same in all: " + html(same) + "</p>\n";
}

std::string ComparePage::text() const {
  Page page;
  page.title = "relook compare";
  page.styles = {"page.css", "viewer.css", "scopes.css", "compare.css"};
  page.scripts = {"page.js",    "beside.js",    "pixels.js", "curves.js", "display_gl.js",
                  "display.js", "region.js",    "scopes.js", "words.js",  "viewer_input.js",
                  "viewer.js",  "pair_view.js", "link.js",   "compare.js"};
  page.body = "<h1>relook compare</h1>\n" + with_viewer(asset_text("compare.html")) + "<main>\n" + pairs_ + runs_ +
              "<p>relook " + html(program_version()) + "</p>\n</main>\n";
  std::vector<std::pair<double, std::string>> frames = frames_;
  std::ranges::stable_sort(frames, std::ranges::greater(), [](const auto& frame) { return frame.first; });
  std::string list;
  for (const auto& [badness, frame] : frames) list += (list.empty() ? "" : ",\n") + frame;
  page.data = {{"compared", "{\"exposure\":" + Json(exposure_).dump() + ",\"frames\":[" + list + "]}"}};
  return page_text(page);
}

}  // namespace relook
