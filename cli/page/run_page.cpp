#include "page/run_page.h"

#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "page/page.h"
#include "page/run_pixels.h"
#include "trace/ray_tree.h"

namespace relook {
namespace {

std::string op_name(PatchOp op) {
  constexpr const char* kNames[] = {"add", "remove", "replace", "move", "copy", "test"};
  return kNames[static_cast<std::size_t>(op)];
}

Json edit_json(const Edit& edit) {
  Json operations = Json::array();
  for (const PatchOperation& operation : edit) {
    Json entry{{"op", op_name(operation.op)}, {"path", operation.path}};
    if (!operation.from.empty()) entry["from"] = operation.from;
    if (operation.op == PatchOp::add || operation.op == PatchOp::replace || operation.op == PatchOp::test)
      entry["value"] = operation.value;
    operations.push_back(std::move(entry));
  }
  return operations;
}

/// What the journal has for each entry of a report; null for what no edit made.
Json edits_json(const Json& steps, const Journal& journal) {
  Json edits = Json::array();
  for (const Json& entry : steps) {
    edits.push_back(nullptr);
    const auto number = entry.at("step").get<std::size_t>();
    if (number == 0 || number > journal.steps.size()) continue;
    const JournalStep& step = journal.steps[number - 1];
    const std::span<const Edit> frames = frames_of(step);
    Json edit{{"select", step.select}};
    for (const char* kind : {"drag_frame", "wedge_frame"})
      if (entry.at(kind).is_number()) edit["edit"] = edit_json(frames[entry.at(kind).get<std::size_t>() - 1]);
    if (!edit.contains("edit") && step.drag.empty() && step.wedge.empty()) edit["edit"] = edit_json(step.edit);
    edits.back() = std::move(edit);
  }
  return edits;
}

/// Files of overlays/ that belong to an entry, by kind: "touched" -> "overlays/0003_touched.png".
Json overlays_of(const std::filesystem::path& folder, const Json& entry) {
  Json overlays = Json::object();
  const std::string stem = std::filesystem::path(entry.at("preview").get<std::string>()).stem().string();
  for (const char* kind : {"dependent", "touched", "groups", "tunnels"}) {
    const std::string name = "overlays/" + stem + "_" + kind + ".png";
    std::error_code error;
    if (std::filesystem::is_regular_file(folder / name, error)) overlays[kind] = name;
  }
  return overlays;
}

/// The overlays of all entries: files beside the page, or the images themselves when all of them fit.
Json overlays_json(const std::filesystem::path& folder, const Json& steps, std::size_t embedded_bytes) {
  Json all = Json::array();
  std::size_t bytes = 0;
  for (const Json& entry : steps) {
    all.push_back(overlays_of(folder, entry));
    for (const auto& [kind, name] : all.back().items())
      bytes += std::filesystem::file_size(folder / name.get<std::string>());
  }
  if (bytes > embedded_bytes) return all;
  for (Json& overlays : all)
    for (auto& overlay : overlays.items())
      overlay.value() = png_url(read_file(folder / overlay.value().get<std::string>()));
  return all;
}

std::string data_name(std::size_t entry) {
  char name[32];
  std::snprintf(name, sizeof name, "pixels/%05zu.js", entry);
  return name;
}

/// The frames of a run, as its page has them.
struct PagePixels {
  Json layout, thumbnails = Json::array();
  Json embedded = nullptr;  // base64 by entry; null: files beside the page
};

/// Writes files beside the page as soon as the page is known to be too small for them.
PagePixels page_pixels(const std::filesystem::path& folder, const Json& steps, std::size_t embedded_bytes) {
  PagePixels page;
  RunPixels run;
  std::vector<std::string> texts;  // of the entries that are in no file yet
  std::size_t written = 0, bytes = 0;
  bool is_beside = false;
  Json tiles = Json::array();
  for (const Json& entry : steps) {
    const std::string name = entry.at("frame").get<std::string>();
    FramePixels pixels = run.take(read_file(folder / name), (folder / name).string());
    page.thumbnails.push_back(png_url(pixels.thumbnail));
    tiles.push_back({{"tiles", pixels.tiles}, {"sizes", pixels.sizes}});
    texts.push_back(base64(pixels.bytes));
    bytes += texts.back().size();
    if (!is_beside && bytes > embedded_bytes) {
      is_beside = true;
      make_folders(folder / "pixels");
    }
    for (std::size_t i = 0; is_beside && i < texts.size(); ++i, ++written)
      write_file(folder / data_name(written), "relook_pixels(" + std::to_string(written) + ",\"" + texts[i] + "\");\n");
    if (is_beside) texts.clear();
  }
  Json channels = Json::array();
  for (const FrameTiles::Channel& channel : run.channels())
    channels.push_back({{"name", channel.name}, {"bytes", channel.bytes}});
  page.layout = {{"width", run.last().width()},
                 {"height", run.last().height()},
                 {"tile", kTileSize},
                 {"channels", std::move(channels)},
                 {"entries", std::move(tiles)}};
  if (!is_beside) page.embedded = std::move(texts);
  return page;
}

}  // namespace

void write_run_page(const std::filesystem::path& folder, const Json& report, const Journal& journal,
                    std::size_t embedded_bytes) {
  const Json& steps = report.at("steps");
  PagePixels pixels = page_pixels(folder, steps, embedded_bytes);
  Page page;
  page.title = "relook: " + journal.name;
  page.styles = {"page.css", "report.css"};
  page.scripts = {"chart.min.js", "page.js", "pixels.js", "viewer.js", "plots.js", "words.js", "keys.js", "report.js"};
  page.body = asset_text("report.html");
  page.has_files_beside = pixels.embedded.is_null();
  page.data = {{"report", report},
               {"edits", edits_json(steps, journal)},
               {"thumbnails", std::move(pixels.thumbnails)},
               {"overlays", overlays_json(folder, steps, embedded_bytes)},
               {"layout", std::move(pixels.layout)},
               {"pixels", std::move(pixels.embedded)}};
  write_file(folder / "report.html", page_text(page));
}

}  // namespace relook
