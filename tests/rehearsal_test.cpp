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
  check_journal(state, journal_of(edits));
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
  EXPECT_EQ(state.slot_counts().objects, counts.objects);
  EXPECT_EQ(state.slot_counts().materials, counts.materials);
  EXPECT_EQ(state.slot_counts().lights, counts.lights);

  std::vector<std::string> wrong = edits;
  wrong.push_back(R"([{"op": "remove", "path": "/nodes/Sphere"}])");
  EXPECT_EQ(message_of([&] { check_journal(state, journal_of(wrong)); }), "j.json: /edit/0/path: no node \"Sphere\"");
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
  check_journal(state, journal_of({range, range, mapping + "]"}));
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
  EXPECT_EQ(message_of([&] {
              check_journal(state, journal_of({range, failing}));
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
    EXPECT_EQ(message_of([&] { check_journal(state, journal_of({edit})); }),
              "j.json: /edit/0/path: a name must not be empty");
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
