#include "page_browser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <vector>

#include "base/files.h"
#include "frame/frame_file.h"

namespace relook {
namespace {

/// "3" for a step, "3_01" for a frame of its drag or wedge: as the frame's file is numbered.
std::string label_of(const Json& step) {
  const std::string stem = std::filesystem::path(step["frame"].get<std::string>()).stem().string();
  const bool is_within = step["drag_frame"].is_number() || step["wedge_frame"].is_number();
  return std::to_string(step["step"].get<int>()) + (is_within ? stem.substr(stem.find('_')) : "");
}

}  // namespace

Json page_expectations(const std::filesystem::path& run, bool has_overlays) {
  const Bytes bytes = read_file(run / "report.json");
  const Json report = parse_json(text_of(bytes), "report.json");
  const Json& steps = report["steps"];
  Json expected{{"labels", Json::array()}, {"names", Json::array()}, {"pixels", Json::array()}};
  for (const Json& step : steps) {
    expected["labels"].push_back(label_of(step));
    expected["names"].push_back(step["name"]);
  }
  std::vector<std::size_t> by_change;
  for (std::size_t i = 1; i < steps.size(); ++i) by_change.push_back(i);
  std::ranges::stable_sort(by_change, std::ranges::greater(),
                           [&](std::size_t i) { return steps[i]["pixels_changed"].get<std::uint64_t>(); });
  expected["by_change"] = by_change;
  for (const std::size_t entry : {std::size_t{1}, steps.size() - 1}) {
    const std::string name = steps[entry]["frame"].get<std::string>();
    const Frame frame = decode_exr(run / name);
    const std::uint32_t x = frame.width / 2 + 9, y = frame.height / 2 - 7;
    const Rgba& pixel = frame.pixels[std::size_t{y} * frame.width + x];
    expected["pixels"].push_back(
        {{"entry", entry}, {"x", x}, {"y", y}, {"rgba", {pixel.r, pixel.g, pixel.b, pixel.a}}, {"frame", name}});
  }
  expected["overlays"] = Json::array();
  for (const Json& step : steps) {
    const std::string stem = std::filesystem::path(step["preview"].get<std::string>()).stem().string();
    Json kinds = Json::array();
    for (const char* kind : {"dependent", "touched", "groups", "tunnels"})
      if (has_overlays && std::filesystem::exists(run / "overlays" / (stem + "_" + kind + ".png")))
        kinds.push_back(kind);
    expected["overlays"].push_back(std::move(kinds));
  }
  return expected;
}

void use_in_browser(const std::string& script, const std::filesystem::path& run, const Json& expected,
                    const ScratchFolder& folder) {
  std::ofstream(folder / "expected.json") << expected.dump();
  const std::filesystem::path pages = std::filesystem::path(RELOOK_SOURCE_DIR) / "tests/pages";
  const char* kept = std::getenv("RELOOK_SCREENSHOTS");  // a folder to keep them in
  const ProgramResult result =
      run_program({"python3", (pages / script).string(), run.string(), (folder / "expected.json").string(),
                   kept != nullptr ? kept : (folder / "").string()});
  if (result.exit_code == 77) GTEST_SKIP() << "no chromium and chromedriver: report.html is NOT tried in a browser";
  EXPECT_EQ(result.exit_code, 0) << result.output;
  if (result.exit_code == 0) std::cout << result.output;
}

}  // namespace relook
