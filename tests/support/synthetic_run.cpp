#include "synthetic_run.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "base/files.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "frame/frame_file.h"
#include "frame/preview.h"
#include "page/run_page.h"

namespace relook {
namespace {

void write_quickly(const std::filesystem::path& path, BytesView bytes) {
  std::ofstream(path, std::ios::binary) << text_of(bytes);
}

std::string numbered(std::size_t step) {
  char text[32];
  std::snprintf(text, sizeof text, "%04zu", step);
  return text;
}

}  // namespace

SyntheticRun::SyntheticRun(std::filesystem::path folder, std::uint32_t width, std::uint32_t height, Pixel pixel)
    : folder_(std::move(folder)), width_(width), height_(height), pixel_(std::move(pixel)) {
  set_thread_count(1);  // to wake others takes longer than a tile of these frames
  std::filesystem::create_directories(folder_ / "frames");
  std::filesystem::create_directories(folder_ / "previews");
  head = {{"program", "0"},
          {"scene", {{"file", "some/scene.gltf"}, {"hash", "5"}}},
          {"journal", {{"file", "journal.json"}, {"hash", "6"}}},
          {"camera", "Camera"},
          {"resolution", {width, height}},
          {"samples", 1},
          {"options", {{"integrator", "whitted"}, {"max_depth", 6}}},
          {"machine", {{"threads", 2}, {"cpu", "unknown"}}},
          {"full_render_seconds", 0.5},
          {"cache_bytes", {{"total", 1000}}},
          {"cache_damage", Json::array()},
          {"interrupted", false}};
  journal.name = "journal";
}

Json& SyntheticRun::add(std::size_t step, const std::string& within) {
  Frame frame;
  frame.width = width_;
  frame.height = height_;
  for (std::uint32_t y = 0; y < height_; ++y)
    for (std::uint32_t x = 0; x < width_; ++x) frame.pixels.push_back(pixel_(entries.size(), x, y));
  const std::string stem = numbered(step) + within;
  write_quickly(folder_ / ("frames/" + stem + ".exr"), encode_exr(frame, {}, PixelFormat::half));
  write_quickly(folder_ / ("previews/" + stem + ".png"), encode_png(frame, previews));
  return add_entry(step, stem, !within.empty());
}

Json& SyntheticRun::add_sharing(std::size_t step) {
  const std::string stem = std::filesystem::path(entries.back()["frame"].get<std::string>()).stem().string();
  return add_entry(step, stem, false);
}

Json& SyntheticRun::add_wedge(std::size_t step, const Json& axes) {
  std::size_t count = 1;
  for (const Json& axis : axes) count *= axis["texts"].size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = std::to_string(i + 1);
    Json& entry = add(step, "_" + std::string(number.size() < 2 ? 1 : 0, '0') + number);
    entry["drag_frame"] = nullptr;
    entry["wedge_frame"] = i + 1;
    entry["values"] = Json::array();
    std::size_t later = count;  // frames of one value of the axis
    for (const Json& axis : axes) {
      const std::size_t of_axis = axis["texts"].size();
      later /= of_axis;
      entry["values"].push_back(
          {{"path", axis["path"]}, {"label", axis["label"]}, {"text", axis["texts"][i / later % of_axis]}});
    }
  }
  const Json values = entries.back()["values"];
  Json& own = add_sharing(step);
  own["values"] = values;
  own["axes"] = axes;
  return own;
}

Json& SyntheticRun::add_linked(std::size_t step, std::size_t to) {
  const std::string stem = numbered(step);
  std::filesystem::create_hard_link(folder_ / entries[to]["frame"].get<std::string>(),
                                    folder_ / ("frames/" + stem + ".exr"));
  std::filesystem::create_hard_link(folder_ / entries[to]["preview"].get<std::string>(),
                                    folder_ / ("previews/" + stem + ".png"));
  return add_entry(step, stem, false);
}

Json& SyntheticRun::add_entry(std::size_t step, const std::string& stem, bool is_within) {
  const double seconds = 0.001 * static_cast<double>(1 + step * 37 % 100);
  const Json moves{{"ray_trees", 0},   {"sample_colors", 0}, {"light_sums", 0},
                   {"color_trees", 0}, {"tunnels", 0},       {"total", 0}};
  entries.push_back({{"step", step},
                     {"name", "step " + std::to_string(step)},
                     {"class", step == 0 ? "base" : "color"},
                     {"reasons", {"/materials/Paint/pbrMetallicRoughness/baseColorFactor is a colour"}},
                     {"drag_frame", nullptr},
                     {"wedge_frame", nullptr},
                     {"frame", "frames/" + stem + ".exr"},
                     {"preview", "previews/" + stem + ".png"},
                     {"pixels_changed", 1 + step * 7919 % 4096},
                     {"samples_affected", step * 104729 % 65536},
                     {"regions_visited", 12},
                     {"regions_culled", 3},
                     {"ray_tests", step * 15485863 % 1000000},
                     {"ray_tests_culled", step * 32452843 % 1000000},
                     {"ray_updates", 0},
                     {"shadow_updates", 0},
                     {"color_trees_evaluated", 4096},
                     {"color_trees_reused", 1024},
                     {"seconds",
                      {{"classify", seconds / 7},
                       {"select", seconds / 9},
                       {"test", 0.0},
                       {"update", 0.0},
                       {"evaluate", seconds / 3},
                       {"write", seconds / 5},
                       {"total", seconds}}},
                     {"resident",
                      {{"ray_paths", 123456},
                       {"ray_trees", 2345678 + step},
                       {"sample_colors", 2345678},
                       {"light_sums", 0},
                       {"kept_rays", 0},
                       {"kept_segments", 0},
                       {"kept_terms", 0},
                       {"kept_vertices", 0},
                       {"color_trees", 1111111},
                       {"groups", 234567},
                       {"tunnels", 1000000},
                       {"total", 7160490 + step}}},
                     {"evicted", moves},
                     {"rebuilt", moves},
                     {"reloaded", moves},
                     {"resumed", false},
                     {"verify", nullptr}});
  if (is_within) entries.back()["drag_frame"] = std::stoi(stem.substr(stem.find('_') + 1));
  return entries.back();
}

void SyntheticRun::write_page(std::size_t count, bool reads_pixels, std::function<void()> check) const {
  const ReportEntries list{std::min(count, entries.size()), [this](std::size_t i) { return entries[i]; }};
  Json told = head;
  told["options"]["exposure"] = previews.exposure;
  write_run_page({folder_, told, list, journal, reads_pixels, std::move(check), previews.view});
}

void SyntheticRun::write_report() const {
  Json report = head;
  report["steps"] = entries;
  std::ofstream(folder_ / "report.json") << report.dump();
}

Json SyntheticRun::expected_pixel(std::size_t entry, std::uint32_t x, std::uint32_t y) const {
  const std::string name = entries[entry]["frame"].get<std::string>();
  const Frame frame = decode_exr(folder_ / name);
  const Rgba& pixel = frame.pixels[std::size_t{y} * frame.width + x];
  return {{"entry", entry}, {"x", x}, {"y", y}, {"rgba", {pixel.r, pixel.g, pixel.b, pixel.a}}, {"frame", name}};
}

std::uint64_t folder_bytes(const std::filesystem::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder, error))
    if (file.is_regular_file()) bytes += file.file_size();
  return bytes;
}

std::vector<std::pair<std::string, std::string>> folder_hashes(const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, std::string>> hashes;
  std::error_code error;
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder, error))
    if (file.is_regular_file()) hashes.emplace_back(file.path().string(), hash128(read_file(file.path())));
  std::ranges::sort(hashes);
  return hashes;
}

}  // namespace relook
