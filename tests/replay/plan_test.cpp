// `relook plan` against what a replay then reports, over the rows of the paper's Tables 1 and 3.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kProject = RELOOK_SOURCE_DIR;

struct PlanCase {
  std::filesystem::path scene, journal;
  std::string resolution;
  std::vector<std::string> view;
};

Json read_json(const std::filesystem::path& path) {
  const Bytes bytes = read_file(path);
  return parse_json(text_of(bytes), path.string());
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.empty() ? 0 : values[values.size() / 2];
}

/// Plans, replays, and compares: the same frames and classes, and samples and pixels within 20 % in the median.
void expect_good_plan(const PlanCase& plan, const ScratchFolder& folder) {
  const std::string cache = (folder / "cache").string(), run = (folder / "run").string();
  std::vector<std::string> preprocess{"preprocess", plan.scene.string(), "--integrator",  "whitted", "-o",
                                      cache,        "--resolution",      plan.resolution, "--quiet"};
  preprocess.insert(preprocess.end(), plan.view.begin(), plan.view.end());
  ASSERT_EQ(relook(preprocess).exit_code, 0);
  const std::string out = (folder / "plan.json").string();
  const ProgramResult planned = relook({"plan", cache, plan.journal.string(), "--json", out, "--quiet"});
  ASSERT_EQ(planned.exit_code, 0) << planned.output;
  ASSERT_EQ(relook({"replay", cache, plan.journal.string(), "-o", run, "--quiet"}).exit_code, 0);
  const Json frames = read_json(out)["frames"], steps = read_json(std::filesystem::path(run) / "report.json")["steps"];
  ASSERT_EQ(frames.size() + 1, steps.size());
  std::vector<double> samples, pixels, seconds, bytes;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Json &guess = frames[i], &step = steps[i + 1];
    EXPECT_EQ(guess["frame"], step["frame"]);
    EXPECT_EQ(guess["class"], step["class"]) << step["name"];
    const auto off = [&](double predicted, double real) {
      return real == 0 ? (predicted == 0 ? 0 : 1) : std::abs(predicted - real) / real;
    };
    samples.push_back(off(guess["samples_affected"], step["samples_affected"]));
    pixels.push_back(off(guess["pixels_changed"], step["pixels_changed"]));
    const Json& spent = step["seconds"];
    seconds.push_back(off(guess["seconds"], spent["total"].get<double>() - spent["write"].get<double>()));
    bytes.push_back(off(guess["resident_bytes"], step["resident"]["total"]));
  }
  EXPECT_LE(median(samples), 0.2);
  EXPECT_LE(median(pixels), 0.2);
  EXPECT_LE(median(bytes), 0.2);
  std::printf("plan, median error: samples %.3f, pixels %.3f, bytes %.3f, seconds %.3f\n", median(samples),
              median(pixels), median(bytes), median(seconds));
}

TEST(Plan, table1_on_spheres_is_foreseen) {
  const ScratchFolder folder("plan_table1");
  expect_good_plan({.scene = kProject / "scenes/spheres/spheres.gltf",
                    .journal = kProject / "journals/table1.json",
                    .resolution = "640x360",
                    .view = {}},
                   folder);
}

TEST(Plan, table1_with_four_samples_is_foreseen) {
  const ScratchFolder folder("plan_samples");
  expect_good_plan({.scene = kProject / "scenes/spheres/spheres.gltf",
                    .journal = kProject / "journals/table1.json",
                    .resolution = "320x180",
                    .view = {"--samples", "4", "--shadow-bits", "2"}},
                   folder);
}

TEST(Plan, table3_on_garden_is_foreseen) {
  const ScratchFolder folder("plan_table3");
  const ProgramResult made =
      run_program({"python3", (kProject / "scenes" / "generate.py").string(), "garden", (folder / "garden").string()});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  expect_good_plan({.scene = folder / "garden/garden.gltf",
                    .journal = kProject / "journals/table3.json",
                    .resolution = "512x512",
                    .view = {}},
                   folder);
}

TEST(Plan, a_wrong_journal_is_refused_before_anything_is_planned) {
  const ScratchFolder folder("plan_wrong");
  const std::string cache = (folder / "cache").string(), journal = (folder / "wrong.json").string();
  ASSERT_EQ(relook({"preprocess", (kProject / "scenes/spheres/spheres.gltf").string(), "--integrator", "whitted", "-o",
                    cache, "--resolution", "64x36", "--quiet"})
                .exit_code,
            0);
  std::ofstream(journal) << R"({"relook": "journal/1", "steps": [{"edit": [
    {"op": "replace", "path": "/materials/Pant/doubleSided", "value": true}]}]})";
  const ProgramResult result = relook({"plan", cache, journal, "--json=" + (folder / "plan.json").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.output.find("did you mean \"Paint\"?"), std::string::npos) << result.output;
  EXPECT_FALSE(std::filesystem::exists(folder / "plan.json"));
}

}  // namespace
}  // namespace relook
