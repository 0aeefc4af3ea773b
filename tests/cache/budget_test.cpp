// Replays under budgets: frames stay those of full renders whatever leaves memory, by every policy, with and without a
// disk to go to.
#include <gtest/gtest.h>

#include <iostream>

#include "base/parallel.h"
#include "image/render.h"
#include "image/sampling.h"
#include "trace/tree/pack.h"
#include "random_changes.h"
#include "region_checks.h"
#include "run_program.h"
#include "tree_reader.h"
#include "tunnel_caches.h"

namespace relook {
namespace {

constexpr std::size_t kSteps = 60;

struct BudgetCase {
  TestScene scene;
  std::uint32_t samples;
  double ray_trees;  // share
  bool has_disk;
  double memory;  // share of the pieces' bytes; 1: no limit
};

void PrintTo(const BudgetCase& c, std::ostream* out) {
  *out << test_scene_name(c.scene) << ", " << c.samples << " samples, ray trees " << c.ray_trees << ", memory "
       << c.memory << (c.has_disk ? ", disk" : ", no disk");
}

class Budget : public testing::TestWithParam<BudgetCase> {};

/// A limit on pieces alone: what else this process holds does not count.
ResidencyOptions limited(const BudgetCase& c, EvictionPolicy policy, std::uint64_t all_bytes) {
  ResidencyOptions options;
  options.process_bytes = nullptr;
  options.policy = policy;
  if (c.memory < 1) options.memory_bytes = static_cast<std::uint64_t>(c.memory * static_cast<double>(all_bytes));
  if (c.has_disk) options.spill_folder = testing::TempDir();
  return options;
}

std::uint64_t piece_bytes(const BudgetCase& c, const ViewOptions& view) {
  const Resident resident = replayer_of(c.scene, view, {}).resident();
  return resident.ray_trees + resident.sample_colors;
}

void expect_full_render(const Replayer& replayer, const StepResult& step, const Frame& before,
                        const std::string& what) {
  const SceneState again = compiled_again(replayer.state());
  const Frame full = rendered(again.scene(), replayer.image().view);
  ASSERT_EQ(different_pixels(replayer.image().frame, full).size(), 0U) << what;
  ASSERT_EQ(step.changed_pixels.indices(full.width), different_pixels(before, full)) << what;
}

TEST_P(Budget, FramesAreFullRenders) {
  const BudgetCase c = GetParam();
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  Dice dice(seed + static_cast<std::uint64_t>(c.memory * 64) + 31 * c.samples + (c.has_disk ? 7 : 0));
  const ViewOptions view{c.samples, 5, static_cast<std::uint32_t>(dice.below(3))};
  RegionOptions regions;
  regions.tunnels = dice.below(3);
  regions.ray_trees = c.ray_trees;
  const auto policy =
      dice.one_of(std::vector<EvictionPolicy>(std::begin(kEvictionPolicies), std::end(kEvictionPolicies)));
  std::cout << "tunnels " << regions.tunnels << ", policy " << policy_name(policy) << "\n";
  const ResidencyOptions limit = limited(c, policy, piece_bytes(c, view));
  const ScratchFolder folder("budget");
  const bool has_cache = dice.chance(0.5);
  std::cout << (has_cache ? "from a cache\n" : "");
  Replayer replayer = has_cache ? replayer_of_cache(small_scene(c.scene, view), view, regions, folder / "c", limit)
                                : replayer_of(c.scene, view, regions, limit);
  Counters total;
  for (std::size_t k = 1; k <= kSteps; ++k) {
    const bool is_drag = dice.chance(0.2);
    const Json& look = replayer.state().document().look;
    const Change change = is_drag ? random_movement(look, "Ball", dice) : random_change(look, dice);
    const std::string what =
        "seed " + std::to_string(seed) + " step " + std::to_string(k) + " " + Json(change.forward).dump();
    const Frame before = replayer.image().frame;
    const Edit edit = edit_of_list(change.forward);
    const StepResult step = is_drag ? replayer.drag(edit, "random", ".") : replayer.step(edit, "random", ".");
    total += step.counters;
    ASSERT_NO_FATAL_FAILURE(expect_full_render(replayer, step, before, what));
    if (!is_drag) continue;
    const Frame dragged = replayer.image().frame;
    ASSERT_NO_FATAL_FAILURE(expect_full_render(replayer, replayer.release(), dragged, what + " released"));
  }
  if (c.memory < 1) {
    EXPECT_GT(total.evicted.ray_trees + total.evicted.sample_colors + total.evicted.color_trees, 0U);
    EXPECT_EQ(total.reloaded.ray_trees + total.reloaded.sample_colors > 0, c.has_disk);
  }
  if (c.ray_trees < 1) {
    EXPECT_GT(total.object_rays, 0U);
    EXPECT_GT(total.rebuilt.ray_trees, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Budget,
    testing::Values(BudgetCase{TestScene::spheres, 1, 0, false, 1}, BudgetCase{TestScene::cards, 4, 0, false, 1},
                    BudgetCase{TestScene::study, 1, 0.5, false, 1}, BudgetCase{TestScene::cards, 1, 1, true, 0},
                    BudgetCase{TestScene::study, 4, 1, true, 0.3}, BudgetCase{TestScene::spheres, 4, 1, true, 0.7},
                    BudgetCase{TestScene::study, 1, 1, false, 0.6}, BudgetCase{TestScene::spheres, 1, 0.3, true, 0.2},
                    BudgetCase{TestScene::cards, 4, 1, false, 0.8}));

TEST(Eviction, gives_memory_back) {
  ResidencyOptions options;
  options.process_bytes = nullptr;
  options.memory_bytes = 0;
  options.spill_folder = testing::TempDir();
  Replayer replayer = replayer_of(TestScene::spheres, {4, 5, 0}, {}, options);
  static_cast<void>(replayer.step({}, "nothing changes", "."));
  EXPECT_EQ(replayer.resident().ray_trees, 0U);
  EXPECT_EQ(replayer.resident().sample_colors, 0U);
}

TEST(MissingRayTrees, come_back_once_they_are_used) {
  SceneState state = test_scene(TestScene::spheres, 80, 60);
  Image image = preprocessed(state.scene(), {1, 6, 0});
  for (TileTrees& trees : image.trees) trees = {std::move(trees.paths), {}, {}};  // as of a cache without them
  const std::string light = state.document().look.at("lights").begin().key();
  RegionOptions regions;
  regions.color_trees = 0;
  Replayer replayer(std::move(state), std::move(image), regions);
  EXPECT_EQ(replayer.resident().ray_trees, 0U);
  std::vector<std::uint64_t> rays;
  for (const int intensity : {4, 5, 6, 7})
    rays.push_back(
        replayer.step(replace_edit("/lights/" + light + "/intensity", intensity), "test", ".").counters.object_rays);
  EXPECT_GT(rays.front(), 0U);
  EXPECT_EQ(rays.back(), 0U);
  EXPECT_GT(replayer.resident().ray_trees, 0U);
  const Frame before = replayer.image().frame;
  const StepResult step =
      replayer.step(replace_edit("/nodes/Ball/extensions/KHR_node_visibility/visible", false), "test", ".");
  EXPECT_EQ(step.counters.object_rays, 0U);
  expect_full_render(replayer, step, before, "hidden");
}

TEST(ObjectRays, find_every_hit_of_every_tree_again) {
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    const SceneState state = test_scene(scene, 80, 60);
    const Image image = preprocessed(state.scene(), {1, 6, 2});
    const RayScene rays(state.scene());
    const ObjectLevels objects(rays);
    const GrowScene grow{rays, nullptr, 6, 2, &objects};
    const PrimaryRays primaries(state.scene().camera, image.view);
    for (std::size_t tile = 0; tile < image.trees.size(); ++tile) {
      const TileTrees& trees = image.trees[tile];
      const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
      for (std::uint32_t sample = 0; sample < trees.paths.size(); ++sample) {
        const auto path = image.paths.words(trees.paths[sample]);
        TreeBlock block;
        GrowCounters counters;
        const std::uint32_t root = expand_tree(grow, primaries.ray(rect, sample), sample,
                                               {PathCursor(path, grow.layout()), std::nullopt}, block, counters);
        std::vector<std::uint32_t> words;
        std::vector<Hit> hits;
        pack(block, root, grow.layout(), words, hits);
        ASSERT_TRUE(std::ranges::equal(words, path)) << tile << " " << sample;
        ASSERT_TRUE(std::ranges::equal(hits, trees.hits_of(sample))) << tile << " " << sample;
      }
    }
  }
}

}  // namespace
}  // namespace relook
