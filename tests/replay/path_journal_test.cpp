// Journals of mixed edits under `path` from a printed seed (RELOOK_SEED=<number> repeats or varies them), from memory
// or a cache, with one thread or four: after every step, drag and release pixels, sums of light and ray trees are those
// of a fresh preprocess, and edits that are undone give all of it back.
#include <gtest/gtest.h>

#include <iostream>

#include "base/parallel.h"
#include "path_checks.h"
#include "random_lights.h"
#include "run_program.h"

namespace relook {
namespace {

constexpr std::size_t kSteps = 40;

struct JournalCase {
  TestScene scene;
  std::uint32_t samples;
  std::size_t threads;
  bool has_cache = false;
};
void PrintTo(const JournalCase& c, std::ostream* out) {
  *out << test_scene_name(c.scene) << ", " << c.samples << " samples, " << c.threads << " threads"
       << (c.has_cache ? ", from a cache" : "");
}
std::string journal_case_name(const testing::TestParamInfo<JournalCase>& info) {
  const JournalCase& c = info.param;
  return std::string(test_scene_name(c.scene)) + "_" + std::to_string(c.samples) + "_samples_" +
         std::to_string(c.threads) + "_threads" + (c.has_cache ? "_cache" : "");
}

class PathJournal : public testing::TestWithParam<JournalCase> {
 protected:
  ~PathJournal() override { set_thread_count(0); }

  /// A dice of the case, whose seed is printed.
  static Dice dice_of(const JournalCase& c, std::uint64_t salt) {
    std::cout << "RELOOK_SEED=" << seed_of_run() << "\n";
    return Dice(seed_of_run() + salt * (c.samples + 1) + 31 * static_cast<std::uint64_t>(c.scene) + c.threads);
  }
  static Replayer start(const JournalCase& c, const ScratchFolder& folder) {
    const SceneState state = c.samples == 1 ? test_scene(c.scene, 68, 18) : test_scene(c.scene, 28, 21);
    return path_replayer(state, path_view(c.samples), {}, {}, c.has_cache ? folder / "c" : std::filesystem::path());
  }
};

std::string told(std::size_t step, const Change& change) {
  return "seed " + std::to_string(seed_of_run()) + " step " + std::to_string(step) + " " + Json(change.forward).dump();
}

void drag_at_random(Replayer& replayer, Dice& dice, std::size_t step) {
  const std::size_t frames = 1 + dice.below(3);
  const std::string node = dice.one_of(std::vector<std::string>{"Ball", "GlassBall", "Lamp"});
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const Change change = random_movement(replayer.state().document().look, node, dice);
    expect_path_step(replayer, edit_of_list(change.forward), "drag, " + told(step, change), {true, false}, true);
  }
  const Frame before = replayer.image().frame;
  const StepResult step_of_release = replayer.release();
  EXPECT_TRUE(step_of_release.changed_pixels.empty()) << "release of step " << step;
  EXPECT_EQ(pixel_differences(replayer.image().frame, before), "") << "release of step " << step;
  expect_path_image(replayer, "release of step " + std::to_string(step), {true, false});
}

TEST_P(PathJournal, EveryStepGivesAFreshImage) {
  const JournalCase c = GetParam();
  set_thread_count(c.threads);
  Dice dice = dice_of(c, 7919);
  const ScratchFolder folder("path_journal");
  Replayer replayer = start(c, folder);
  expect_path_image(replayer, "at first");
  std::size_t steps_that_changed = 0;
  for (std::size_t k = 1; k <= kSteps; ++k) {
    const Change change = random_path_change(replayer.state().document().look, dice);
    const StepResult step =
        expect_path_step(replayer, edit_of_list(change.forward), told(k, change), {true, k % 10 == 0});
    steps_that_changed += step.changed_pixels.empty() ? 0 : 1;
    if (dice.chance(0.1)) drag_at_random(replayer, dice, k);
    ASSERT_FALSE(HasFailure()) << "no further steps after " << told(k, change);
  }
  EXPECT_GT(steps_that_changed, kSteps / 3);
}

TEST_P(PathJournal, UndoneToTheStartGivesTheFirstSumsBack) {
  const JournalCase c = GetParam();
  set_thread_count(c.threads);
  Dice dice = dice_of(c, 104729);
  const ScratchFolder folder("path_journal_undone");
  Replayer replayer = start(c, folder);
  const Json first_look = replayer.state().document().look;
  std::vector<std::pair<Frame, std::vector<PackedSums>>> images;
  std::vector<Change> changes;
  for (std::size_t k = 0; k < kSteps / 2; ++k) {
    images.emplace_back(replayer.image().frame, replayer.image().light_sums);
    changes.push_back(random_path_change(replayer.state().document().look, dice));
    static_cast<void>(replayer.step(edit_of_list(changes.back().forward), "path", "."));
  }
  expect_path_image(replayer, "before the first step back");
  for (std::size_t k = changes.size(); k-- > 0;) {
    static_cast<void>(replayer.step(edit_of_list(changes[k].backward), "path", "."));
    ASSERT_EQ(pixel_differences(replayer.image().frame, images[k].first), "") << "undone: " << told(k, changes[k]);
    ASSERT_TRUE(replayer.image().light_sums == images[k].second) << "sums, undone: " << told(k, changes[k]);
  }
  EXPECT_EQ(replayer.state().document().look, first_look);
  expect_path_image(replayer, "at the start again");
}

INSTANTIATE_TEST_SUITE_P(Seeded, PathJournal,
                         testing::Values(JournalCase{TestScene::lights, 1, 1}, JournalCase{TestScene::lights, 2, 4},
                                         JournalCase{TestScene::lights, 4, 4, true},
                                         JournalCase{TestScene::study, 1, 4, true},
                                         JournalCase{TestScene::study, 3, 1}, JournalCase{TestScene::cards, 4, 4},
                                         JournalCase{TestScene::spheres, 2, 1, true}),
                         journal_case_name);

TEST(PathThreads, do_not_change_a_bit) {
  std::vector<PackedSums> first;
  Frame first_frame;
  for (const std::size_t threads : {1U, 4U, 2U}) {
    set_thread_count(threads);
    const SceneState state = lights_scene(130, 12);  // three tiles
    Replayer replayer = path_replayer(state, path_view(2));
    Dice dice(1);
    for (std::size_t k = 0; k < 12; ++k) {
      const Change change = random_light_change(replayer.state().document().look, dice);
      static_cast<void>(replayer.step(edit_of_list(change.forward), "path", "."));
    }
    if (first.empty()) {
      first = replayer.image().light_sums;
      first_frame = replayer.image().frame;
    }
    EXPECT_EQ(pixel_differences(replayer.image().frame, first_frame), "") << threads << " threads";
    EXPECT_TRUE(replayer.image().light_sums == first) << threads << " threads";
    set_thread_count(0);
  }
}

}  // namespace
}  // namespace relook
