// Which tunnels preprocess writes (paper 3.4): as many as the limit allows, by tile, and what a replay says of those
// that it does not read.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "cache/manifest.h"
#include "region/tunnel_shape.h"
#include "run_program.h"
#include "tunnel_caches.h"

namespace relook {
namespace {

TEST(CellLevels, KeepWithinALimitAndUseMostOfIt) {
  for (const auto& [width, height] : {std::pair{256U, 256U}, {1920U, 1080U}, {70U, 3U}, {1U, 1U}})
    for (const std::size_t of_region : {1U, 2U, 4U})
      for (const std::uint64_t limit : {0U, 1U, 30U, 200U, 1000U, 5461U, 40000U, 400000U, 10000000U}) {
        const TunnelShape shape{of_region, 2, limit};
        const std::vector<std::uint8_t> levels = cell_levels(shape, width, height);
        const std::size_t columns = (width + 63) / 64, rows = (height + 63) / 64;
        std::uint64_t tunnels = regions_above_tiles(width, height);
        std::uint64_t all = tunnels;
        for (std::size_t tile = 0; tile < columns * rows; ++tile) {
          const auto tile_width = std::min<std::size_t>(64, width - tile % columns * 64);
          const auto tile_height = std::min<std::size_t>(64, height - tile / columns * 64);
          const auto count = [&](std::uint32_t lowest) {
            std::uint64_t sum = of_region > 1 || lowest > kTileLevel ? 1 : 0;
            for (std::uint32_t level = lowest; level <= kTileLevel; ++level) {
              const std::size_t size = std::size_t{1} << level;
              sum += of_region * ((tile_width + size - 1) / size) * ((tile_height + size - 1) / size);
            }
            return sum;
          };
          all += count(2);
          if (!levels.empty()) tunnels += count(levels[tile]);
        }
        SCOPED_TRACE(std::to_string(width) + " " + std::to_string(of_region) + " " + std::to_string(limit));
        if (levels.empty()) {
          EXPECT_LT(limit, columns * rows + regions_above_tiles(width, height));
          continue;
        }
        EXPECT_LE(tunnels, limit);
        EXPECT_GE(tunnels, std::min(all, limit * 2 / 3)) << "of " << all;
      }
}

TEST(Preprocess, WritesTunnelsAndAReplayReadsThemOrSaysWhyNot) {
  const ScratchFolder folder("preprocess_tunnels");
  const std::string scene = (std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();
  const std::string journal = (folder / "j.json").string();
  std::ofstream(journal) << R"({"relook": "journal/1", "steps": [{"name": "up", "edit": [
      {"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0, 1.2, 0]}]}]})";
  const auto run = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), RELOOK_PROGRAM);
    return run_program(arguments);
  };
  const auto replayed = [&](const std::string& cache, const std::string& name, std::vector<std::string> options) {
    std::vector<std::string> arguments{"replay", (folder / cache).string(), journal,
                                       "-o",     (folder / name).string(),  "--verify"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const Json report = parse_json(text_of(read_file(folder / name / "report.json")), "report.json");
    return std::pair(result.output, report);
  };
  const auto written = [&](const std::string& cache, std::vector<std::string> options) {
    std::vector<std::string> arguments{
        "preprocess", scene, "--integrator", "whitted", "-o", (folder / cache).string(), "--resolution", "160x90"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments).exit_code, 0);
    Json manifest;
    EXPECT_EQ(read_manifest(folder / cache, manifest).fault, CacheFault::none);
    return manifest["content"];
  };
  EXPECT_EQ(written("none", {"--tunnels", "0"})["pieces"]["tunnels"], 0);
  EXPECT_GT(written("one", {})["pieces"]["tunnels"], 100);
  EXPECT_GT(written("two", {"--tunnels", "2"})["pieces"]["tunnels"], 200);
  EXPECT_LE(written("few", {"--most-tunnels", "60", "--tunnel-levels", "3"})["pieces"]["tunnels"], 60);
  for (const char* cache : {"one", "two", "few"}) {
    const auto [text, report] = replayed(cache, std::string("run_") + cache, {});
    EXPECT_GT(report["steps"][1]["tunnels_read"], 0) << cache;
    EXPECT_EQ(text.find("others are built"), std::string::npos) << text;
  }
  EXPECT_EQ(replayed("none", "run_none", {}).second["steps"][1]["tunnels_read"], 0);
  const auto [text, report] = replayed("two", "run_other", {"--tunnels", "1"});
  EXPECT_NE(text.find("others are built"), std::string::npos) << text;
  EXPECT_EQ(report["steps"][1]["tunnels_read"], 0);
  EXPECT_EQ(replayed("two", "run_without", {"--tunnels", "0"}).second["steps"][1]["tunnels_read"], 0);
}

}  // namespace
}  // namespace relook
