// --memory as the operating system sees it: the peak of the whole program, with --verify and without, and the floor
// that a refusal names.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/json.h"
#include "base/system/sanitizers.h"
#include "run_program.h"

namespace relook {
namespace {

constexpr double kAbove = 1.05;  // what a peak may be of its limit

class MemoryLimit : public testing::Test {
 protected:
  void SetUp() override {
    if (kIsInstrumented) GTEST_SKIP() << "sanitizers take memory of their own";
    ASSERT_EQ(run_program({RELOOK_PROGRAM, "preprocess", kScene, "--integrator", "whitted", "-o", at("c"),
                           "--resolution", "800x450", "--quiet"})
                  .exit_code,
              0);
    std::ofstream(at("j.json")) << R"({"relook": "journal/1", "steps": [
      {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                                  "value": [0.1, 0.9, 0.1, 1]}]},
      {"name": "denser", "edit": [{"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_ior/ior",
                                   "value": 1.8}]},
      {"name": "moved", "edit": [{"op": "replace", "path": "/nodes/CentralSphere/translation",
                                  "value": [0.2, 1, 0.1]}]},
      {"name": "light", "edit": [{"op": "replace", "path": "/nodes/Lamp/translation", "value": [-1, 5.5, 4]}]},
      {"name": "red", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                                "value": [0.9, 0.1, 0.1, 1]}]}]})";
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] MeasuredResult replay(std::vector<std::string> options) const {
    std::vector<std::string> command{"replay",  at("c"),   at("j.json"),  "-o",        at("run"),
                                     "--quiet", "--fresh", "--overwrite", "--threads", "2"};
    command.insert(command.end(), options.begin(), options.end());
    return measure_relook(std::move(command));
  }
  [[nodiscard]] static std::vector<std::string> limited(std::vector<std::string> options, double megabytes) {
    options.insert(options.end(), {"--memory", std::to_string(static_cast<int>(megabytes)) + "M"});
    return options;
  }

  void expect_within(const std::vector<std::string>& options, double megabytes, bool may_be_refused) const {
    const MeasuredResult run = replay(limited(options, megabytes));
    if (may_be_refused && run.exit_code == 4) return;
    EXPECT_EQ(run.exit_code, 0) << megabytes << ": " << run.output;
    EXPECT_LE(run.peak_mib, kAbove * megabytes) << run.output;
  }

  /// At the floor that a refusal names, somewhat below and above it.
  void expect_limits_kept(const std::vector<std::string>& options) const {
    const MeasuredResult free = replay(options);
    ASSERT_EQ(free.exit_code, 0) << free.output;
    const MeasuredResult refused = replay(limited(options, 1));
    ASSERT_EQ(refused.exit_code, 4) << refused.output;
    const std::string words = "needs at least ";
    const std::size_t named = refused.output.find(words);
    ASSERT_NE(named, std::string::npos) << refused.output;
    const double floor = std::stod(refused.output.substr(named + words.size()));
    const MeasuredResult at_floor = replay(limited(options, floor));
    EXPECT_EQ(at_floor.exit_code, 0) << floor << ": " << at_floor.output;
    EXPECT_LE(at_floor.peak_mib, kAbove * floor);
    EXPECT_GE(at_floor.peak_mib, 0.85 * floor) << "less would do";
    expect_within(options, 0.9 * floor, true);
    expect_within(options, floor + 0.3 * std::max(0.0, free.peak_mib - floor), false);
  }

  ScratchFolder folder_{"memory_limit"};
};

TEST_F(MemoryLimit, is_kept_and_the_floor_that_is_named_works) { expect_limits_kept({}); }

TEST_F(MemoryLimit, holds_full_renders_to_compare_with_too) { expect_limits_kept({"--verify"}); }

}  // namespace
}  // namespace relook
