// Long journals of mixed edits from a printed seed (RELOOK_SEED=<number> repeats or varies them): after every step the
// frame has the bits of a full render, and edits followed by their inverses give earlier frames back.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "base/parallel.h"
#include "image/render.h"
#include "random_changes.h"
#include "region_checks.h"
#include "replay/chosen_parameters.h"
#include "replay/replay.h"
#include "run_program.h"
#include "test_scenes.h"
#include "tree_reader.h"
#include "tunnel_caches.h"

namespace relook {
namespace {

constexpr std::size_t kSteps = 200;

struct RandomCase {
  TestScene scene;
  std::uint32_t samples;
  std::size_t threads;
  std::uint32_t shadow_bits = 0;
};

void PrintTo(const RandomCase& c, std::ostream* out) {
  *out << test_scene_name(c.scene) << ", " << c.samples << " samples, " << c.threads << " threads, " << c.shadow_bits
       << " shadow bits";
}

class RandomJournal : public testing::TestWithParam<RandomCase> {
 protected:
  ~RandomJournal() override { set_thread_count(0); }
};

std::string random_case_name(const testing::TestParamInfo<RandomCase>& info) {
  return std::string(test_scene_name(info.param.scene)) + "_" + std::to_string(info.param.samples) + "_samples_" +
         std::to_string(info.param.threads) + "_threads_" + std::to_string(info.param.shadow_bits) + "_bits";
}

RegionOptions random_regions(Dice& dice) {
  RegionOptions regions;
  regions.groups = dice.one_of(std::vector<std::size_t>{0, 1, 4});
  regions.tunnels = dice.below(3);
  regions.atoms = static_cast<std::uint32_t>(dice.below(3));
  regions.tunnel_levels = static_cast<std::uint32_t>(dice.below(kTileLevel + 1));
  if (dice.chance(0.3)) regions.most_tunnels = dice.below(1000);
  regions.color_trees = dice.one_of(std::vector<double>{0, 0.01, 0.1, 1});
  std::cout << "groups " << regions.groups << ", tunnels " << regions.tunnels << ", atoms " << regions.atoms
            << ", color trees " << regions.color_trees << ", tunnel levels " << regions.tunnel_levels
            << ", most tunnels " << regions.most_tunnels.value_or(~std::uint64_t{0}) << "\n";
  return regions;
}

/// A replay of a small image of a scene, or of its cache.
Replayer random_replayer(TestScene scene, const ViewOptions& view, Dice& dice, const ScratchFolder& folder) {
  const RegionOptions regions = random_regions(dice);
  if (dice.chance(0.5)) return replayer_of(scene, view, regions);
  std::cout << "from a cache\n";
  return replayer_of_cache(small_scene(scene, view), view, regions, folder / "c");
}

/// Perhaps only colour trees of a few things are kept.
void choose_at_random(Replayer& replayer, Dice& dice) {
  if (dice.chance(0.5)) return;
  SceneState again = compiled_again(replayer.state());
  std::vector<ParameterSet> sets;
  for (const char* pointer : {"/materials/Matte", "/materials/Mirror/pbrMetallicRoughness", "/lights", "/scene"})
    if (dice.chance(0.5)) sets.push_back(parameters_at(again, pointer));
  replayer.choose_parameters(sets);
  std::cout << sets.size() << " sets of parameters chosen\n";
}

void expect_full_render(const Replayer& replayer, const std::string& what) {
  const SceneState again = compiled_again(replayer.state());
  ASSERT_EQ(different_pixels(replayer.image().frame, rendered(again.scene(), replayer.image().view)).size(), 0U)
      << what;
}

void expect_fresh_structures(const Replayer& replayer, const std::string& what) {
  const SceneState again = compiled_again(replayer.state());
  const Image fresh = preprocessed(again.scene(), replayer.image().view);
  ASSERT_EQ(different_trees(replayer.image(), replayer.state().scene(), fresh, again.scene()), 0U) << what;
  ASSERT_EQ(stale_tiles(replayer), 0U) << what;
}

/// The same places with other values, where that is possible: consecutive edits of one selection.
std::vector<Json> with_other_values(const std::vector<Json>& operations, Dice& dice) {
  std::vector<Json> others;
  for (Json operation : operations) {
    if (!operation.contains("value")) return {};
    Json& value = operation["value"];
    const std::string path = operation["path"];
    if (value.is_number())
      value = path.ends_with("/ior") ? dice.between(1, 2.5) : dice.between(0, 1);
    else if (value.is_array() && value.size() == 3)
      value = dice.color();
    else
      return {};
    others.push_back(std::move(operation));
  }
  return others;
}

/// A drag of several frames, of one node after the other; then the release.
void drag_at_random(Replayer& replayer, Dice& dice, const std::string& what) {
  const std::size_t frames = 1 + dice.below(4);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const std::string node = dice.one_of(std::vector<std::string>{"Ball", "MirrorBall", "GlassBall", "Ball", "Lamp"});
    const Change change = random_movement(replayer.state().document().look, node, dice);
    const Frame before = replayer.image().frame;
    const StepResult step = replayer.drag(edit_of_list(change.forward), "random", ".");
    const std::string where = what + " drag " + Json(change.forward).dump();
    expect_full_render(replayer, where);
    ASSERT_EQ(step.changed_pixels.indices(before.width), different_pixels(before, replayer.image().frame)) << where;
    if (testing::Test::HasFatalFailure()) return;
  }
  const Frame before = replayer.image().frame;
  const StepResult step = replayer.release();
  ASSERT_TRUE(step.changed_pixels.empty()) << what;
  ASSERT_EQ(different_pixels(before, replayer.image().frame).size(), 0U) << what;
  expect_fresh_structures(replayer, what);
}

TEST_P(RandomJournal, EveryFrameIsAFullRender) {
  const auto [scene, samples, threads, shadow_bits] = GetParam();
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  set_thread_count(threads);
  Dice dice(seed + 7919 * samples + static_cast<std::uint64_t>(scene));
  const ViewOptions view{samples, 5, shadow_bits};
  const ScratchFolder folder("random_journal");
  Replayer replayer = random_replayer(scene, view, dice, folder);
  choose_at_random(replayer, dice);
  std::size_t steps_that_changed = 0;
  for (std::size_t k = 1; k <= kSteps; ++k) {
    const Change change = random_change(replayer.state().document().look, dice);
    const Frame before = replayer.image().frame;
    const std::uint64_t segments = replayer.segments();
    const StepResult step = replayer.step(edit_of_list(change.forward), "random", ".");
    const SceneState again = compiled_again(replayer.state());
    const Frame full = rendered(again.scene(), view);
    const std::string what =
        "seed " + std::to_string(seed) + " step " + std::to_string(k) + " " + Json(change.forward).dump();
    ASSERT_EQ(different_pixels(replayer.image().frame, full).size(), 0U) << what;
    ASSERT_EQ(step.changed_pixels.indices(full.width), different_pixels(before, full)) << what;
    ASSERT_EQ(step.counters.ray_tests + step.counters.ray_tests_culled, segments) << what;
    steps_that_changed += step.changed_pixels.empty() ? 0 : 1;
    if (k % 10 == 0) {
      ASSERT_NO_FATAL_FAILURE(expect_fresh_structures(replayer, what));
    }
    if (const auto others = with_other_values(change.forward, dice); !others.empty() && dice.chance(0.5)) {
      replayer.step(edit_of_list(others), "random", ".");
      ASSERT_NO_FATAL_FAILURE(expect_full_render(replayer, what + " then " + Json(others).dump()));
      replayer.step(edit_of_list(change.forward), "random", ".");
      ASSERT_NO_FATAL_FAILURE(expect_full_render(replayer, what + " and again"));
    }
    if (dice.chance(0.1)) {
      ASSERT_NO_FATAL_FAILURE(drag_at_random(replayer, dice, what));
    }
    if (!dice.chance(0.2)) continue;
    const Change next = random_change(replayer.state().document().look, dice);
    const Frame there = replayer.image().frame;
    replayer.step(edit_of_list(next.forward), "random", ".");
    replayer.step(edit_of_list(next.backward), "random", ".");
    ASSERT_EQ(different_pixels(replayer.image().frame, there).size(), 0U) << "undone after: " << what;
  }
  EXPECT_GT(steps_that_changed, kSteps / 3);
}

TEST_P(RandomJournal, UndoneToTheStartGivesTheFirstFrameBack) {
  const auto [scene, samples, threads, shadow_bits] = GetParam();
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  set_thread_count(threads);
  Dice dice(seed + 104729 * samples + static_cast<std::uint64_t>(scene));
  const ScratchFolder folder("random_journal_undone");
  Replayer replayer = random_replayer(scene, {samples, 5, shadow_bits}, dice, folder);
  const Json first_look = replayer.state().document().look;
  std::vector<Frame> frames = {replayer.image().frame};
  std::vector<Change> changes;
  for (std::size_t k = 0; k < 30; ++k) {
    changes.push_back(random_change(replayer.state().document().look, dice));
    replayer.step(edit_of_list(changes.back().forward), "random", ".");
    frames.push_back(replayer.image().frame);
    ASSERT_EQ(different_pixels(frames.back(), rendered(compiled_again(replayer.state()).scene(), {samples, 5})).size(),
              0U)
        << "seed " << seed << " " << Json(changes.back().forward).dump();
  }
  for (std::size_t k = changes.size(); k-- > 0;) {
    replayer.step(edit_of_list(changes[k].backward), "random", ".");
    ASSERT_EQ(different_pixels(replayer.image().frame, frames[k]).size(), 0U)
        << "seed " << seed << " undoing " << Json(changes[k].forward).dump();
  }
  EXPECT_EQ(replayer.state().document().look, first_look);
}

INSTANTIATE_TEST_SUITE_P(Seeded, RandomJournal,
                         testing::Values(RandomCase{TestScene::spheres, 1, 1}, RandomCase{TestScene::cards, 1, 2},
                                         RandomCase{TestScene::study, 1, 2}, RandomCase{TestScene::spheres, 4, 2},
                                         RandomCase{TestScene::cards, 4, 1}, RandomCase{TestScene::study, 4, 1},
                                         RandomCase{TestScene::spheres, 1, 2, 1}, RandomCase{TestScene::cards, 1, 2, 2},
                                         RandomCase{TestScene::study, 1, 1, 3}, RandomCase{TestScene::cards, 4, 2, 4}),
                         random_case_name);

}  // namespace
}  // namespace relook
