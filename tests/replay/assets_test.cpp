// Other people's glTF scenes under journals written for them (journals/assets): every frame is that of a full render.
// The scenes lie beside the project, in ../shared/assets; without that folder the tests skip and say so.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kJournals = std::filesystem::path(RELOOK_SOURCE_DIR) / "journals" / "assets";
const std::filesystem::path kAssets = std::filesystem::path(RELOOK_SOURCE_DIR) / ".." / "shared" / "assets";

/// One row of manifest.json; empty strings: the flag is not given.
struct Asset {
  std::string name, file, camera, lights, look, journal;
};

std::vector<Asset> read_manifest() {
  const Bytes bytes = read_file(kJournals / "manifest.json");
  const Json manifest = parse_json(text_of(bytes), "manifest.json");
  std::vector<Asset> assets;
  for (const Json& row : manifest.at("assets")) {
    assets.push_back(
        {row.at("name"), row.at("file"), row.at("camera"), row.at("lights"), row.at("look"), row.at("journal")});
  }
  return assets;
}

class AssetReplay : public testing::TestWithParam<Asset> {};

TEST_P(AssetReplay, is_exact) {
  const Asset& asset = GetParam();
  if (!std::filesystem::exists(kAssets))
    GTEST_SKIP() << "no ../shared/assets beside the project: " << asset.file << " is NOT tested";
  ReplayCase replay{
      .scene = kAssets / asset.file, .journal = kJournals / asset.journal, .resolution = "192x108", .view = {}};
  const auto flag = [&](const char* name, const std::string& value) {
    if (!value.empty()) replay.view.insert(replay.view.end(), {name, value});
  };
  flag("--camera", asset.camera);
  flag("--lights", asset.lights);
  flag("--look", asset.look.empty() ? "" : (kJournals / asset.look).string());
  const ScratchFolder folder("asset_" + asset.name);
  const Json report = verified_report(replay, folder);
  expect_exact_steps(report);
}

INSTANTIATE_TEST_SUITE_P(Assets, AssetReplay, testing::ValuesIn(read_manifest()), [](const auto& row) {
  std::string name;
  std::ranges::transform(row.param.name, std::back_inserter(name), [](char c) { return c == '-' ? '_' : c; });
  return name;
});

}  // namespace
}  // namespace relook
