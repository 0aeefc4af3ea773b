// A cache that another program exchanges while a replay is under way: a run is of one cache, and its frames are those
// of full renders of that one.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

TEST(ExchangedCache, IsNeverMixedWithTheOneThatWasThere) {
  const ScratchFolder folder("exchanged");
  const std::string scene = (std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();
  const auto at = [&](const std::string& name) { return (folder / name).string(); };
  const auto run = [](std::vector<std::string> arguments) { return run_program(arguments); };
  std::ofstream(at("up.json"))
      << R"([{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0, 1.4, 0]}])";
  for (const char* name : {"one", "two"})
    std::ofstream(at(std::string(name) + ".json")) << R"({"relook": "journal/1", "steps": [{"name": "move", "edit": [
      {"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.3, 1.2, 0]}]}]})";
  const std::vector<std::string> small{"--resolution", "64x36", "--quiet"};
  const auto preprocess = [&](const std::string& cache, std::vector<std::string> options) {
    std::vector<std::string> words{RELOOK_PROGRAM, "preprocess", scene, "--integrator", "whitted", "-o", at(cache)};
    words.insert(words.end(), small.begin(), small.end());
    words.insert(words.end(), options.begin(), options.end());
    ASSERT_EQ(run(words).exit_code, 0);
  };
  std::size_t exchanged = 0, unharmed = 0;
  for (int opening = 1; opening <= 9; ++opening) {
    for (const char* name : {"a", "b", "run"}) std::filesystem::remove_all(at(name));
    preprocess("a", {});
    preprocess("b", {"--look", at("up.json")});
    const ProgramResult result = run({"env", std::string("LD_PRELOAD=") + RELOOK_FAULT_SHIM,
                                      "RELOOK_EXCHANGE=" + std::to_string(opening) + ":" + at("a") + ":" + at("b"),
                                      RELOOK_PROGRAM, "replay", at("a"), at("one.json"), at("two.json"), "-o",
                                      at("run"), "--verify", "--memory", "2G", "--progress", "none"});
    ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 75) << opening << ": " << result.output;
    if (result.exit_code == 75) {
      ++exchanged;
      EXPECT_NE(result.output.find("has exchanged the cache"), std::string::npos) << result.output;
      continue;
    }
    ++unharmed;
    Json frames;
    for (const char* name : {"one", "two"}) {
      const Json report =
          parse_json(text_of(read_file(folder / "run" / name / "report.json")), std::string(name) + "/report.json");
      if (frames.is_null()) frames = report["steps"][1]["frame_hash"];
      EXPECT_EQ(report["steps"][1]["frame_hash"], frames) << "both runs are of one cache, opening " << opening;
      for (const Json& step : report["steps"]) EXPECT_EQ(step["verify"]["pixels_different"], 0);
    }
  }
  EXPECT_GT(exchanged, 0U);
  EXPECT_GT(unharmed, 0U);
}

TEST(Text, ThatWouldReorderALineIsMarked) {
  EXPECT_EQ(printable("a\xE2\x80\xAE"
                      "b\xD8\x9C"
                      "c\xE2\x81\xA7"
                      "d\xE2\x80\xA8"
                      "e"),
            "a?b?c?d?e");
  EXPECT_EQ(printable("\xD7\x90\xD7\x91 \xD8\xA7 \xE2\x82\xAC"), "\xD7\x90\xD7\x91 \xD8\xA7 \xE2\x82\xAC")
      << "alphabets stay";
  EXPECT_EQ(without_reordering("x\xE2\x80\x8F\ny\xE2\x81\xA6"), "x\xEF\xBF\xBD\ny\xEF\xBF\xBD");
  EXPECT_EQ(without_reordering("\xE2\x80"), "\xE2\x80");
}

}  // namespace
}  // namespace relook
