// Replays under `path` and a budget: sums of light and ray trees leave memory and come back from disk, or trees are
// found again; pixels and sums stay those of a fresh preprocess, from memory or from a cache.
#include <gtest/gtest.h>

#include <iostream>

#include "image/render.h"
#include "path_checks.h"
#include "random_lights.h"
#include "run_program.h"

namespace relook {
namespace {

constexpr std::size_t kSteps = 25;

struct PathBudgetCase {
  const char* name;
  double memory;  // share of all pieces' bytes; without a disk of the ray trees', beside room for the sums
  bool has_disk;
  double ray_trees = 1;  // share that is kept
  bool has_cache = false;
};
void PrintTo(const PathBudgetCase& c, std::ostream* out) { *out << c.name; }

class PathBudget : public testing::TestWithParam<PathBudgetCase> {};

SceneState wide_scene() { return lights_scene(130, 12); }  // three tiles

/// A limit on pieces alone: what else this process holds does not count.
ResidencyOptions limited(const PathBudgetCase& c, const Resident& all) {
  const auto share_of = [](double share, std::uint64_t bytes) {
    return static_cast<std::uint64_t>(share * static_cast<double>(bytes));
  };
  ResidencyOptions options;
  options.process_bytes = nullptr;
  if (c.has_disk) options.spill_folder = testing::TempDir();
  if (c.memory < 1)
    options.memory_bytes = c.has_disk ? share_of(c.memory, all.ray_trees + all.light_sums)
                                      : all.light_sums + all.light_sums / 4 + share_of(c.memory, all.ray_trees);
  return options;
}

TEST_P(PathBudget, SumsStayThoseOfAFreshPreprocess) {
  const PathBudgetCase c = GetParam();
  std::cout << "RELOOK_SEED=" << seed_of_run() << "\n";
  Dice dice(seed_of_run() + static_cast<std::uint64_t>(c.memory * 64) + (c.has_disk ? 7 : 0));
  const ViewOptions view = path_view(2);
  const Resident all = path_replayer(wide_scene(), view).resident();
  EXPECT_GT(all.light_sums, 0U);
  EXPECT_GT(all.ray_trees, 0U);
  EXPECT_EQ(all.sample_colors, 0U);
  RegionOptions regions;
  regions.ray_trees = c.ray_trees;
  const ScratchFolder folder("path_budget");
  Replayer replayer = path_replayer(wide_scene(), view, limited(c, all), regions,
                                    c.has_cache ? folder / "c" : std::filesystem::path());
  Counters total;
  for (std::size_t k = 1; k <= kSteps; ++k) {
    const bool is_drag = dice.chance(0.2);
    const Json& look = replayer.state().document().look;
    const Change change = is_drag ? random_movement(look, "Ball", dice) : random_path_change(look, dice);
    const std::string what =
        "seed " + std::to_string(seed_of_run()) + " step " + std::to_string(k) + " " + Json(change.forward).dump();
    total += expect_path_step(replayer, edit_of_list(change.forward), what, {false, false}, is_drag).counters;
    if (is_drag) {
      total += replayer.release().counters;
      expect_path_image(replayer, what + " released", {false, false});
    }
    ASSERT_FALSE(HasFailure()) << "no further steps after " << what;
  }
  if (c.memory < 1) {
    EXPECT_GT(total.evicted.ray_trees + total.evicted.light_sums, 0U);
    EXPECT_EQ(total.reloaded.ray_trees + total.reloaded.light_sums > 0, c.has_disk);
  }
}

INSTANTIATE_TEST_SUITE_P(Shares, PathBudget,
                         testing::Values(PathBudgetCase{"a_tenth_on_disk", 0.1, true},
                                         PathBudgetCase{"half_on_disk", 0.5, true},
                                         PathBudgetCase{"most_on_disk_of_a_cache", 0.8, true, 1, true},
                                         PathBudgetCase{"trees_found_again", 0.3, false},
                                         PathBudgetCase{"no_trees_kept", 1, false, 0},
                                         PathBudgetCase{"some_trees_kept_of_a_cache", 1, false, 0.5, true},
                                         PathBudgetCase{"few_trees_on_disk", 0.4, true, 0.4}),
                         [](const testing::TestParamInfo<PathBudgetCase>& budget) {
                           return std::string(budget.param.name);
                         });

/// What steps keep for the next has a ceiling where nothing else has.
TEST(PathBudgetOfDerived, is_kept_to_and_changes_no_frame) {
  const auto kept = [](const Resident& resident) {
    return resident.kept_rays + resident.kept_segments + resident.kept_terms + resident.kept_vertices;
  };
  std::vector<std::uint64_t> most;
  for (const std::uint64_t ceiling : {std::uint64_t{1} << 40, std::uint64_t{100000}, std::uint64_t{0}}) {
    ResidencyOptions options;
    options.most_derived_bytes = ceiling;
    Replayer replayer = path_replayer(wide_scene(), path_view(2), options);
    Dice dice(seed_of_run() + 9);
    most.push_back(0);
    for (std::size_t k = 1; k <= kSteps; ++k) {
      const Change change = random_path_change(replayer.state().document().look, dice);
      const std::string what =
          std::to_string(ceiling) + " step " + std::to_string(k) + " " + Json(change.forward).dump();
      expect_path_step(replayer, edit_of_list(change.forward), what, {false, false});
      most.back() = std::max(most.back(), kept(replayer.resident()));
      ASSERT_LE(kept(replayer.resident()), ceiling + ceiling / 4 + 1000)
          << what << ", but for what vectors hold beside";
    }
  }
  EXPECT_GT(most[0], most[1]);
  EXPECT_GT(most[1], 0U);
  EXPECT_LT(most[2], 1000U);
}

TEST(PathCache, of_an_edited_document_goes_on_as_the_replay_does) {
  const ScratchFolder folder("path_cache");
  Dice dice(seed_of_run() + 5);
  Replayer replayer = path_replayer(wide_scene(), path_view(2));
  for (std::size_t k = 0; k < 8; ++k)
    static_cast<void>(
        replayer.step(edit_of_list(random_path_change(replayer.state().document().look, dice).forward), "path", "."));
  Replayer again = path_replayer(compiled_again(replayer.state()), path_view(2), {}, {}, folder / "c");
  ASSERT_EQ(again.state().scene().integrator, Integrator::path);
  EXPECT_EQ(pixel_differences(again.image().frame, replayer.image().frame), "");
  EXPECT_TRUE(again.image().light_sums == replayer.image().light_sums);
  for (std::size_t k = 0; k < 8; ++k) {
    const std::string what = "step " + std::to_string(k);
    const Change change = random_path_change(replayer.state().document().look, dice);
    static_cast<void>(replayer.step(edit_of_list(change.forward), "path", "."));
    expect_path_step(again, edit_of_list(change.forward), what, {true, false});
    EXPECT_EQ(pixel_differences(again.image().frame, replayer.image().frame), "") << what;
    EXPECT_TRUE(again.image().light_sums == replayer.image().light_sums) << what;
  }
}

TEST(PathCache, with_lost_tiles_is_made_good) {
  const ScratchFolder folder("path_cache");
  const SceneState state = wide_scene();
  Image image = preprocessed(state.scene(), path_view(2));
  const std::vector<PackedSums> sums = image.light_sums;
  RenderStats stats;
  image.light_sums[1] = PackedSums();
  image.trees[1] = {};
  const std::size_t lost[] = {1};
  rebuild_tiles(state.scene(), image, lost, stats);
  EXPECT_TRUE(image.light_sums == sums);
  Replayer replayer(compiled_again(state), std::move(image));
  expect_path_image(replayer, "rebuilt");
}

}  // namespace
}  // namespace relook
