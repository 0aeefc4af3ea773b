// A journal is rehearsed before anything is written; a drag stays with its selection.
#include <gtest/gtest.h>

#include "edit/apply.h"
#include "look_fixture.h"

namespace relook {
namespace {

/// Steps read as a journal would give them.
Journal journal_of(const std::vector<std::string>& edits) {
  Journal journal;
  journal.file = "j.json";
  for (const std::string& edit : edits) {
    JournalStep step;
    step.where = "/steps/" + std::to_string(journal.steps.size());
    step.edit = edit_of(edit);
    journal.steps.push_back(std::move(step));
  }
  return journal;
}

/// Of the intensity of the light Bulb, in the first step.
Wedge wedge_of(const std::vector<Json>& values) {
  WedgeAxis axis;
  axis.path = "/lights/Bulb/intensity";
  axis.values = values;
  axis.count = values.size();
  axis.where = "/steps/0/wedge";
  return {{axis}};
}

TEST(Rehearsal, leaves_the_state_exactly_as_it_was) {
  SceneState state = small_state();
  const Json look = state.document().look;
  const std::string scene = scene_text(state.scene());
  const SlotCounts counts = state.slot_counts();
  const std::vector<std::string> edits{
      R"([{"op": "add", "path": "/nodes/N", "value": {"mesh": "Ball"}}, {"op": "add", "path": "/materials/M", "value": {}}])",
      R"([{"op": "replace", "path": "/nodes/N/translation", "value": [1, 1, 1]}, {"op": "remove", "path": "/nodes/Group"}])",
      R"([{"op": "add", "path": "/nodes/L", "value": {"extensions": {"KHR_lights_punctual": {"light": "Cone"}}}}])",
      R"([{"op": "replace", "path": "/scene/extras/relook/ambient", "value": [1, 1, 1]}])"};
  (void)check_journal(state, journal_of(edits));
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
  EXPECT_EQ(state.slot_counts().objects, counts.objects);
  EXPECT_EQ(state.slot_counts().materials, counts.materials);
  EXPECT_EQ(state.slot_counts().lights, counts.lights);

  std::vector<std::string> wrong = edits;
  wrong.push_back(R"([{"op": "remove", "path": "/nodes/Sphere"}])");
  EXPECT_EQ(message_of([&] { (void)check_journal(state, journal_of(wrong)); }),
            "j.json: /edit/0/path: no node \"Sphere\"");
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
  for (const std::string& edit : edits) (void)apply_json(state, edit);
}

TEST(Rehearsal, takes_back_a_replace_of_what_was_absent) {
  SceneState state = small_state();
  const Json look = state.document().look;
  const std::string scene = scene_text(state.scene());
  const std::string mapping = R"([
    {"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_volume/attenuationDistance", "value": 0.5},
    {"op": "replace", "path": "/materials/Gold/pbrMetallicRoughness/baseColorTexture/extras/relook/mapping",
     "value": {"kind": "planar"}})";
  const std::string range = R"([{"op": "replace", "path": "/lights/Bulb/range", "value": 4}])";
  const std::string failing = mapping + R"(, {"op": "replace", "path": "/lights/Cone/range", "value": 0}])";
  (void)check_journal(state, journal_of({range, range, mapping + "]"}));
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
  EXPECT_EQ(message_of([&] {
              (void)check_journal(state, journal_of({range, failing}));
            }),
            "j.json: /edit/2/value: 0 is not above 0");
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
}

// It used to pass here, and to fail in the middle of the replay.
TEST(Rehearsal, refuses_an_entry_with_an_empty_name) {
  SceneState state = small_state();
  for (const char* edit : {R"([{"op": "add", "path": "/nodes/", "value": {"mesh": "Ball"}}])",
                           R"([{"op": "add", "path": "/lights/", "value": {"type": "point"}}])",
                           R"([{"op": "add", "path": "/textures/", "value": {"source": "WoodImage"}}])",
                           R"([{"op": "add", "path": "/materials/", "value": {}},
                               {"op": "replace", "path": "/meshes/Ball/primitives/0/material", "value": ""}])"})
    EXPECT_EQ(message_of([&] { (void)check_journal(state, journal_of({edit})); }),
              "j.json: /edit/0/path: a name must not be empty");
}

TEST(Rehearsal, names_every_wrong_step_and_judges_each_without_those_before) {
  SceneState state = small_state();
  const Json look = state.document().look;
  const std::string scene = scene_text(state.scene());
  const std::string bad = R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 7},
                              {"op": "remove", "path": "/nodes/Nobody"}])";
  const std::string good = R"([{"op": "test", "path": "/lights/Bulb/intensity", "value": 30},
                               {"op": "add", "path": "/materials/New", "value": {}}])";
  const std::string builds_on = R"([{"op": "replace", "path": "/materials/New/alphaCutoff", "value": 0.1}])";
  EXPECT_EQ(message_of([&] {
              (void)check_journal(state, journal_of({builds_on, bad, good, builds_on, bad}));
            }),
            "j.json: /edit/0/path: no material \"New\"\n"
            "j.json: /edit/1/path: no node \"Nobody\"\n"
            "j.json: /edit/1/path: no node \"Nobody\"");
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
  (void)check_journal(state, journal_of({good, builds_on}));
  EXPECT_EQ(state.document().look, look);
}

TEST(Rehearsal, takes_back_all_of_a_drag_or_wedge_that_goes_wrong) {
  SceneState state = small_state();
  const Json look = state.document().look;
  const std::string scene = scene_text(state.scene());
  Journal journal = journal_of({"[]", R"([{"op": "test", "path": "/lights/Bulb/intensity", "value": 30}])"});
  journal.steps[0].wedge = wedge_of({50, -1, 60});
  const std::string message = message_of([&] { (void)check_journal(state, journal); });
  EXPECT_EQ(message, "j.json: /steps/0/wedge/values/1: -1 is below 0");
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
}

TEST(Rehearsal, names_twenty_wrong_steps_and_counts_the_others) {
  SceneState state = small_state();
  const std::vector<std::string> wrong(23, R"([{"op": "remove", "path": "/nodes/Nobody"}])");
  std::string expected;
  for (int i = 0; i < 20; ++i) expected += "j.json: /edit/0/path: no node \"Nobody\"\n";
  EXPECT_EQ(message_of([&] { (void)check_journal(state, journal_of(wrong)); }),
            expected + "j.json: 3 more steps are wrong");
}

TEST(Rehearsal, warns_of_steps_that_change_nothing) {
  SceneState state = small_state();
  const auto warnings = [&](const std::vector<std::string>& edits) {
    Journal journal = journal_of(edits);
    for (JournalStep& step : journal.steps) step.name = "try";
    return check_journal(state, journal);
  };
  const std::vector<std::string> one{"j.json: /steps/0: \"try\" changes nothing"};
  const std::string same = R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 30}])";
  EXPECT_EQ(warnings({"[]"}), one);
  EXPECT_EQ(warnings({same}), one);
  EXPECT_EQ(warnings({R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 7},
                          {"op": "replace", "path": "/lights/Bulb/intensity", "value": 30}])"}),
            one);
  EXPECT_EQ(warnings({R"([{"op": "add", "path": "/textures/Unused", "value": {"source": "WoodImage"}}])"}),
            std::vector<std::string>{"j.json: /steps/0: \"try\" changes nothing that the scene shows"});
  const std::vector<std::string> none;
  EXPECT_EQ(warnings({R"([{"op": "test", "path": "/lights/Bulb/intensity", "value": 30}])"}), none);
  EXPECT_EQ(warnings({R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 7}])"}), none);
  EXPECT_EQ(warnings({R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 7}])", same}), none);

  const std::vector<std::string> many = warnings(std::vector<std::string>(22, "[]"));
  ASSERT_EQ(many.size(), 21U);
  EXPECT_EQ(many[19], "j.json: /steps/19: \"try\" changes nothing");
  EXPECT_EQ(many[20], "j.json: 2 more steps change nothing");
  EXPECT_EQ(warnings(std::vector<std::string>(21, "[]")).back(), "j.json: 1 more step changes nothing");
}

TEST(Rehearsal, warns_once_of_a_wedge_or_drag_none_of_whose_entries_changes_anything) {
  SceneState state = small_state();
  const auto warnings = [&](const std::vector<Json>& values) {
    Journal journal = journal_of({"[]"});
    journal.steps[0].wedge = wedge_of(values);
    return check_journal(state, journal).size();
  };
  EXPECT_EQ(warnings({30, 30}), 1U);
  EXPECT_EQ(warnings({30, 40}), 0U);  // starts where the scene stands
}

/// A drag of one entry.
JournalStep drag_of(const std::vector<std::string>& select, const std::string& edit) {
  JournalStep step;
  step.where = "/steps/0";
  step.select = select;
  step.drag = {edit_of(edit)};
  return step;
}

TEST(Drag, may_touch_its_selection_and_what_hangs_on_it) {
  const SceneState state = small_state();
  check_drag_scope(state, drag_of({"/nodes/Group"}, R"([{"op": "replace", "path": "/nodes/Hand/matrix/12", "value": 1},
                                                        {"op": "test", "path": "/lights/Bulb/intensity", "value": 1}])"),
                   0, "j.json");
  EXPECT_EQ(message_of([&] {
              check_drag_scope(
                  state,
                  drag_of({"/nodes/Arm"}, R"([{"op": "replace", "path": "/nodes/Sphere/mesh", "value": "Slab"}])"), 0,
                  "j.json");
            }),
            "j.json: /edit/0/path: node \"Sphere\" is not part of the selection");
  EXPECT_EQ(message_of([&] {
              check_drag_scope(
                  state,
                  drag_of({"/nodes/Arm"}, R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 1}])"), 0,
                  "j.json");
            }),
            "j.json: /edit/0/path: a drag moves the nodes of its selection and nothing else");
  EXPECT_EQ(message_of([&] {
              check_drag_scope(state, drag_of({"/nodes/Arm"}, R"([{"op": "remove", "path": "/nodes/Hand"}])"), 0,
                               "j.json");
            }),
            "j.json: /edit/0/path: a drag neither adds nor removes nodes");
  EXPECT_EQ(message_of([&] { check_drag_scope(state, drag_of({"/nodes/Army"}, "[]"), 0, "j.json"); }),
            "j.json: /steps/0/select/0: no node \"Army\"; did you mean \"Arm\"?");
}

}  // namespace
}  // namespace relook
