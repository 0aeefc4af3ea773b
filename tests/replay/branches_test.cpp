// Journals whose steps start from any state before (`from`), whose wedges and drags are put back (`keep`), with grids
// and wildcards, at random from a printed seed: every frame has the bits of a full render, whether those before it were
// made or skipped, and the document is what its own line of steps has made of it.
#include <gtest/gtest.h>

#include <iostream>

#include "path_checks.h"
#include "random_changes.h"
#include "region_checks.h"
#include "replay/journal_replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

constexpr std::size_t kSteps = 24;

struct BranchCase {
  TestScene scene;
  Integrator integrator;
};

void PrintTo(const BranchCase& c, std::ostream* out) {
  *out << test_scene_name(c.scene) << ", " << integrator_word(c.integrator);
}

ViewOptions view_of(const BranchCase& c) { return c.integrator == Integrator::path ? path_view(2) : ViewOptions{1, 5}; }

SceneState state_of(const BranchCase& c) {
  return with_integrator(c.integrator == Integrator::path ? test_scene(c.scene, 36, 27) : test_scene(c.scene, 80, 60),
                         c.integrator);
}

Replayer replayer_of(const BranchCase& c) {
  SceneState state = state_of(c);
  Image image = preprocessed(state.scene(), view_of(c));
  return Replayer(std::move(state), std::move(image));
}

Json replace(const std::string& path, Json value) {
  return {{"op", "replace"}, {"path", path}, {"value", std::move(value)}};
}

/// Writes a journal that can be replayed: each step is made for the document that it starts with.
class BranchAuthor {
 public:
  BranchAuthor(SceneState state, Dice& dice) : state_(std::move(state)), dice_(dice) {
    looks_.push_back(state_.document().look);
    kept_.push_back(0);
  }

  /// The journal; looks(): by step, the document after its last frame.
  Journal write() {
    for (std::size_t step = 1; step <= kSteps; ++step) add_step();
    return parse_journal(Json{{"relook", "journal/1"}, {"steps", steps_}}.dump(), "branches.json");
  }
  [[nodiscard]] const std::vector<Json>& looks() const { return looks_; }

 private:
  void add_step() {
    Json step = Json::object();
    std::size_t start = kept_.back();
    if (dice_.chance(0.6)) {
      const std::size_t from = dice_.below(steps_.size() + 1);
      start = kept_[from];
      step["from"] = from == 0 && dice_.chance(0.5) ? Json("base") : Json(from);
    }
    set_document(looks_[start]);
    const std::size_t form = dice_.below(4);
    if (form == 0)
      add_drag(step);
    else if (form == 1)
      add_wedge(step);
    else
      add_edit(step);
    const bool keep = !step.contains("keep") || step["keep"] == true;
    looks_.push_back(state_.document().look);
    kept_.push_back(keep ? looks_.size() - 1 : start);
    steps_.push_back(std::move(step));
  }

  void add_edit(Json& step) {
    std::vector<Json> operations = random_change(state_.document().look, dice_).forward;
    if (dice_.chance(0.3))
      operations = {replace("/materials/M*/pbrMetallicRoughness/roughnessFactor", dice_.between(0, 1))};
    step["edit"] = operations;
    static_cast<void>(apply_edit(state_, edit_of_list(operations), "author", "."));
  }
  void add_drag(Json& step) {
    step["select"] = {"/nodes/Ball"};
    step["drag"] = Json::array();
    for (std::size_t frame = 0; frame < 2; ++frame) {
      const std::vector<Json> operations = random_movement(state_.document().look, "Ball", dice_).forward;
      step["drag"].push_back(operations);
      static_cast<void>(apply_edit(state_, edit_of_list(operations), "author", "."));
    }
    if (dice_.chance(0.5)) step["keep"] = false;
  }
  void add_wedge(Json& step) {
    Json rows{{"path", "/materials/M*/pbrMetallicRoughness/baseColorFactor"},
              {"values", {{dice_.between(0, 1), 0.5, 0.25, 1}, {0.25, dice_.between(0, 1), 1, 1}}}};
    Json columns{{"path", "/lights/*/intensity"}, {"range", {{"from", 5}, {"to", 40}, {"count", 2}, {"scale", "log"}}}};
    step["wedge"] = dice_.chance(0.5) ? Json{rows, columns} : columns;
    if (dice_.chance(0.5)) step["keep"] = false;
    const Journal one =
        parse_journal(Json{{"relook", "journal/1"}, {"steps", {{{"wedge", step["wedge"]}}}}}.dump(), "one");
    for (std::size_t frame = 0; frame < one.steps[0].frames(); ++frame)
      static_cast<void>(apply_edit(state_, one.steps[0].edit_of(frame), "author", "."));
  }

  void set_document(const Json& look) {
    state_.editable_document().look = look;
    std::vector<TouchedEntity> all;
    for (const auto& [section, entries] : look.items())
      for (const auto& entry : entries.items()) all.push_back({section, section == "scene" ? "" : entry.key()});
    static_cast<void>(state_.recompile(all, "author"));
  }

  SceneState state_;
  Dice& dice_;
  Json steps_ = Json::array();
  std::vector<Json> looks_;
  std::vector<std::size_t> kept_;  // by step: the one whose last frame is the state after it
};

class Branches : public testing::TestWithParam<BranchCase> {};

TEST_P(Branches, EveryFrameIsAFullRenderOfItsOwnLine) {
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  Dice dice(seed + 31 * static_cast<std::uint64_t>(GetParam().scene));
  const ViewOptions view = view_of(GetParam());
  BranchAuthor author(state_of(GetParam()), dice);
  const Journal journal = author.write();
  SceneState rehearsed = state_of(GetParam());
  static_cast<void>(check_journal(rehearsed, journal));

  Replayer made = replayer_of(GetParam()), skipping = replayer_of(GetParam());
  JournalReplay all(journal, made), some(journal, skipping);
  std::vector<Frame> last_frames{made.image().frame};
  for (const JournalEvent& event : JournalWalk(journal)) {
    const std::string what = "seed " + std::to_string(seed) + " " + step_label(event.place);
    const Frame before = made.image().frame;
    static_cast<void>(all.follow(event));
    if (!event.has_frame()) {
      static_cast<void>(some.follow(event));
      continue;
    }
    const Frame full = rendered(compiled_again(made.state()).scene(), view);
    ASSERT_EQ(different_pixels(made.image().frame, full).size(), 0U) << what;
    const Frame& start = event.is_first_frame() ? last_frames[state_before(journal, event.place.step)] : before;
    ASSERT_EQ(all.changed_in_step().indices(full.width), different_pixels(start, full)) << what;
    if (event.is_last_frame()) {
      last_frames.push_back(full);
      ASSERT_EQ(made.state().document().look, author.looks()[event.place.step]) << what;
    }
    if (dice.chance(0.6)) {
      some.skip(event);
      continue;
    }
    static_cast<void>(some.follow(event));
    ASSERT_EQ(different_pixels(skipping.image().frame, full).size(), 0U) << what << " after skipped frames";
  }
}

INSTANTIATE_TEST_SUITE_P(Seeded, Branches,
                         testing::Values(BranchCase{TestScene::spheres, Integrator::whitted},
                                         BranchCase{TestScene::study, Integrator::whitted},
                                         BranchCase{TestScene::cards, Integrator::whitted},
                                         BranchCase{TestScene::spheres, Integrator::path},
                                         BranchCase{TestScene::study, Integrator::path}),
                         [](const auto& tested) {
                           return std::string(test_scene_name(tested.param.scene)) + "_" +
                                  std::string(integrator_word(tested.param.integrator));
                         });

}  // namespace
}  // namespace relook
