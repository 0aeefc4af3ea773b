// The project's own scenes under its own journals: every row of the paper's Tables 1 and 3, and every edit of the product
// shot's lights, surroundings and materials gives, step by step, the frame that a full render gives, bit for bit.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "base/files.h"
#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kProject = RELOOK_SOURCE_DIR;

/// Runs scenes/generate.py; a failure of the test when it fails.
void generate(const std::string& what, const std::filesystem::path& folder) {
  const ProgramResult made =
      run_program({"python3", (kProject / "scenes" / "generate.py").string(), what, folder.string()});
  ASSERT_EQ(made.exit_code, 0) << made.output;
}

std::set<std::string> files_below(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.insert(std::filesystem::relative(entry.path(), folder).string());
  }
  return names;
}

void expect_equal_folders(const std::filesystem::path& made, const std::filesystem::path& kept) {
  EXPECT_EQ(files_below(made), files_below(kept));
  for (const std::string& name : files_below(made)) {
    EXPECT_TRUE(read_file(made / name) == read_file(kept / name))
        << name << " is not what scenes/generate.py writes; run it again";
  }
}

TEST(OwnScenes, generator_writes_the_files_kept_here) {
  const ScratchFolder folder("generated");
  generate("spheres", folder / "spheres");
  expect_equal_folders(folder / "spheres", kProject / "scenes" / "spheres");
  generate("journal-files", folder / "journals");
  expect_equal_folders(folder / "journals/files", kProject / "journals" / "files");
}

TEST(OwnScenes, table1_on_spheres_is_exact) {
  const ScratchFolder folder("table1");
  expect_exact_steps(verified_report({.scene = kProject / "scenes/spheres/spheres.gltf",
                                      .journal = kProject / "journals/table1.json",
                                      .resolution = "192x108",
                                      .view = {}},
                                     folder));
}

TEST(OwnScenes, table1_on_spheres_is_exact_with_four_samples_and_one_thread) {
  const ScratchFolder folder("table1_samples");
  expect_exact_steps(verified_report({.scene = kProject / "scenes/spheres/spheres.gltf",
                                      .journal = kProject / "journals/table1.json",
                                      .resolution = "96x54",
                                      .view = {"--samples", "4", "--threads", "1"}},
                                     folder));
}

TEST(OwnScenes, table3_on_garden_is_exact) {
  const ScratchFolder folder("table3");
  generate("garden", folder / "garden");
  const Json report = verified_report({.scene = folder / "garden/garden.gltf",
                                       .journal = kProject / "journals/table3.json",
                                       .resolution = "256x256",
                                       .view = {}},
                                      folder);
  expect_exact_steps(report, true);
  std::vector<std::string> classes;
  for (const Json& step : report["steps"]) {
    if (classes.empty() || step["step"] != static_cast<int>(classes.size()) - 1) classes.push_back(step["class"]);
  }
  EXPECT_EQ(classes, (std::vector<std::string>{"base", "color", "color", "color", "color", "optical", "geometric",
                                               "geometric", "geometric"}));
}

TEST(OwnScenes, journals_of_product_are_exact) {
  const ScratchFolder folder("product");
  generate("product", folder / "product");
  for (const char* what : {"rotation", "hdris", "lights", "softness", "three-point", "materials"}) {
    SCOPED_TRACE(what);
    const ScratchFolder run(std::string("product_") + what);
    const Json report = verified_report({.scene = folder / "product/product.gltf",
                                         .journal = kProject / "journals" / (std::string("product-") + what + ".json"),
                                         .resolution = "64x36",
                                         .view = {"--integrator", "path", "--samples", "2"}},
                                        run);
    ASSERT_TRUE(report.contains("steps"));
    Json last = 0;  // step: behind the frames of a wedge there is one for where it stays
    for (const Json& step : report["steps"]) {
      SCOPED_TRACE(step["name"].get<std::string>());
      EXPECT_EQ(step["verify"]["pixels_different"], 0);
      EXPECT_GT(step["verify"]["pixels_compared"], 0);
      const bool stays = step["step"] == last && step["wedge_frame"].is_null();
      if (!stays) {
        EXPECT_GT(step["pixels_changed"], 0);
      }
      last = step["step"];
    }
  }
}

}  // namespace
}  // namespace relook
