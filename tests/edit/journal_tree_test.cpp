// Options (`from`), wedges that are put back (`keep`), grids, ranges by steps and ratios, turned rotations, wildcards,
// and what people write beside their steps: read strictly, and walked as they say.
#include <gtest/gtest.h>

#include <cmath>

#include "edit/journal_walk.h"
#include "edit/scene_history.h"
#include "edit/wildcard.h"
#include "look_fixture.h"

namespace relook {
namespace {

Journal journal_of(const std::string& steps) {
  return parse_journal(R"({"relook": "journal/1", "steps": [)" + steps + "]}", "j.json");
}
std::string refusal_of(const std::string& steps) {
  return message_of([&] { static_cast<void>(journal_of(steps)); });
}
std::string dim(const std::string& value, const std::string& more = "") {
  return R"({"edit": [{"op": "replace", "path": "/lights/Bulb/intensity", "value": )" + value + "}]" + more + "}";
}
Wedge wedge_of(const std::string& wedge) { return journal_of(R"({"wedge": )" + wedge + "}").steps[0].wedge; }
std::vector<double> numbers_of(const std::string& range) {
  const Wedge wedge = wedge_of(R"({"path": "/a", "range": )" + range + "}");
  std::vector<double> numbers;
  for (std::size_t i = 0; i < wedge.size(); ++i) numbers.push_back(wedge[i][0].value.get<double>());
  return numbers;
}

/// The intensity of the bulb in each frame.
std::vector<double> intensities(const Journal& journal) {
  SceneState state = small_state();
  SceneHistory history(journal);
  std::vector<double> found;
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    static_cast<void>(apply_event(state, journal, event, history));
    found.push_back(state.document().look.at("/lights/Bulb/intensity"_json_pointer).get<double>());
  });
  return found;
}

TEST(JournalTree, start_from_the_state_after_any_earlier_step) {
  const Journal journal = journal_of(dim("20") + "," + dim("30", R"(, "name": "thirty")") + "," +
                                     R"({"from": "base", "edit": []},{"from": "thirty", "edit": []},)" +
                                     R"({"from": 1, "edit": []},{"edit": []})");
  EXPECT_EQ(intensities(journal), (std::vector<double>{20, 30, 30, 30, 20, 20}));
  EXPECT_EQ(journal.steps[2].from, 0U);
  EXPECT_EQ(journal.steps[3].from, 2U);
  EXPECT_EQ(state_before(journal, 6), 5U);
}

TEST(JournalTree, a_wedge_that_is_not_kept_leaves_what_was_there) {
  const std::string wedge = R"({"wedge": {"path": "/lights/Bulb/intensity", "values": [5, 6]}, "keep": false})";
  const Journal journal =
      journal_of(dim("20") + "," + wedge + "," + wedge + R"(,{"edit": []},{"from": 2, "edit": []})");
  EXPECT_EQ(intensities(journal), (std::vector<double>{20, 5, 6, 5, 6, 20, 20}));
  EXPECT_EQ(state_after(journal, 3), 1U);
}

TEST(JournalTree, what_a_branch_adds_or_removes_is_not_in_the_next) {
  const Journal journal = journal_of(
      R"({"edit": [{"op": "add", "path": "/nodes/New", "value": {"mesh": "Ball"}}, {"op": "remove", "path": "/nodes/Group"}]},
         {"from": "base", "edit": [{"op": "test", "path": "/nodes/Group/children/0", "value": "Sphere"}]},
         {"from": 1, "edit": [{"op": "replace", "path": "/nodes/New/translation", "value": [1, 2, 3]}]})");
  SceneState state = small_state();
  const Json base = state.document().look;
  const std::string scene = scene_text(state.scene());
  EXPECT_EQ(check_journal(state, journal).size(), 0U);
  EXPECT_EQ(state.document().look, base);
  SceneHistory history(journal);
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    static_cast<void>(apply_event(state, journal, event, history));
    if (event.place.step == 2) {
      EXPECT_EQ(state.document().look, base);
      EXPECT_EQ(scene_text(state.scene()), scene);
    }
  });
  EXPECT_FALSE(state.document().look["nodes"].contains("Group"));
  EXPECT_EQ(state.document().look["nodes"]["New"]["translation"], Json({1, 2, 3}));
}

TEST(JournalTree, an_entry_that_came_and_went_within_an_edit_does_not_come_back) {
  SceneState state = small_state();
  Json nodes = state.document().look["nodes"];
  nodes["Ghost"] = {{"mesh", "Ball"}};
  const Json first{{"edit",
                    {{{"op", "replace"}, {"path", "/nodes"}, {"value", nodes}},
                     {{"op", "remove"}, {"path", "/nodes/Ghost"}},
                     {{"op", "replace"}, {"path", "/nodes/Sphere/translation"}, {"value", {1, 2, 3}}}}}};
  const Json base = state.document().look;
  const Journal journal = journal_of(first.dump() + R"(,{"from": "base", "edit": []})");
  SceneHistory history(journal);
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    static_cast<void>(apply_event(state, journal, event, history));
  });
  EXPECT_EQ(state.document().look, base);
}

TEST(JournalTree, the_class_is_that_of_the_edit_where_it_is_made) {
  const Journal journal =
      journal_of(R"({"edit": [{"op": "replace", "path": "/nodes/Sphere/translation", "value": [9, 0, 0]}]},
      {"from": "base", "edit": [{"op": "replace", "path": "/lights/Bulb/intensity", "value": 3}]})");
  SceneState state = small_state();
  SceneHistory history(journal);
  std::vector<EditedScene> edited;
  follow_edits(JournalWalk(journal),
               [&](const JournalEvent& event) { edited.push_back(apply_event(state, journal, event, history)); });
  EXPECT_EQ(edited[1].classification.change, ChangeClass::color);
  EXPECT_FALSE(edited[1].delta.objects.empty());
}

TEST(JournalTree, changes_that_come_to_nothing_are_none) {
  const Journal journal = journal_of(dim("20") + "," + R"({"from": "base", "edit": []})");
  SceneState state = small_state();
  SceneHistory history(journal);
  SceneDelta all;
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    all = merged(std::move(all), apply_event(state, journal, event, history).delta, state.scene());
  });
  EXPECT_TRUE(all.empty());
}

TEST(JournalTree, wrong_origins_are_named) {
  EXPECT_EQ(refusal_of(R"({"edit": [], "from": "base"},{"from": "bass", "edit": []})"),
            R"(j.json: /steps/1/from: no earlier step "bass"; did you mean "base"?)");
  EXPECT_EQ(refusal_of(R"({"from": "late", "edit": []},{"name": "late", "edit": []})"),
            R"(j.json: /steps/0/from: step "late" is not before this one)");
  EXPECT_EQ(refusal_of(R"({"name": "a", "edit": []},{"name": "a", "edit": []},{"from": "a", "edit": []})"),
            R"(j.json: /steps/2/from: two earlier steps are called "a"; say its number)");
  EXPECT_NE(refusal_of(R"({"from": 1, "edit": []})"), "");
  EXPECT_NE(refusal_of(R"({"from": -1, "edit": []})"), "");
  EXPECT_NE(refusal_of(R"({"from": null, "edit": []})"), "");
  EXPECT_EQ(refusal_of(R"({"edit": [], "keep": false})"),
            R"(j.json: /steps/0/keep: only a wedge or a drag has "keep")");
}

TEST(JournalTree, notes_are_carried) {
  const Journal journal = parse_journal(
      R"({"$schema": "s", "relook": "journal/1", "note": "n", "author": "a", "extras": {"shot": 3},
          "steps": [{"edit": [], "note": "brighter?", "author": "b", "extras": [1]}]})",
      "j.json");
  EXPECT_EQ(journal.said.note, "n");
  EXPECT_EQ(journal.said.extras, Json({{"shot", 3}}));
  EXPECT_EQ(journal.steps[0].said.author, "b");
  EXPECT_EQ(journal.steps[0].said.extras, Json({1}));
}

TEST(Wedges, ranges_go_by_count_by_step_and_by_ratio) {
  EXPECT_EQ(numbers_of(R"({"from": 0, "to": 1, "count": 3})"), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(numbers_of(R"({"from": 0, "to": 1, "step": 0.1})").size(), 11U);
  EXPECT_EQ(numbers_of(R"({"from": 0.25, "to": 1, "step": 1.4142135623730951, "scale": "log"})").back(), 1);
  EXPECT_EQ(numbers_of(R"({"from": 0.09, "to": 1, "step": 0.07})").back(), 1);
  EXPECT_EQ(numbers_of(R"({"from": 5, "to": 0, "step": -2, "scale": "step"})"), (std::vector<double>{5, 3, 1}));
  EXPECT_EQ(numbers_of(R"({"from": 1, "to": 16, "step": 2, "scale": "log"})"), (std::vector<double>{1, 2, 4, 8, 16}));
  const std::vector<double> log = numbers_of(R"({"from": 1, "to": 100, "count": 3, "scale": "log"})");
  ASSERT_EQ(log.size(), 3U);
  EXPECT_NEAR(log[1], 10, 1e-12);
  EXPECT_EQ(log[2], 100);
  for (const char* wrong :
       {R"({"from": 0, "to": 1, "count": 3, "scale": "log"})", R"({"from": 0, "to": 1, "step": -1})",
        R"({"from": 0, "to": 1, "step": 0})", R"({"from": 1, "to": 4, "step": 1, "scale": "log"})",
        R"({"from": 0, "to": 1})", R"({"from": 0, "to": 1, "count": 3, "step": 1})",
        R"({"from": 0, "to": 1, "count": 3, "scale": "step"})", R"({"from": [0], "to": [1], "step": 1})",
        R"({"from": 0, "to": 1, "step": 1e-25})", R"({"from": 0, "to": 1, "count": 3, "scale": "cubic"})"})
    EXPECT_THROW(static_cast<void>(numbers_of(wrong)), std::exception) << wrong;
}

TEST(Wedges, rotations_turn_at_an_even_rate_the_shorter_way) {
  const Wedge wedge = wedge_of(
      R"({"path": "/nodes/Sphere/rotation", "range": {"from": [0, 0, 0, 1], "to": [0, -1, 0, 0], "count": 5}})");
  for (std::size_t i = 0; i < 5; ++i) {
    const Json q = wedge[i][0].value;
    const double half = static_cast<double>(i) / 4 * std::acos(0.0);
    EXPECT_NEAR(std::fabs(q[1].get<double>()), std::sin(half), 1e-12) << i;
    EXPECT_NEAR(std::fabs(q[3].get<double>()), std::cos(half), 1e-12) << i;
  }
  const Wedge back = wedge_of(
      R"({"path": "/nodes/Sphere/rotation", "range": {"from": [0, 0, 0, 1], "to": [0, 0, 0, -1], "count": 3}})");
  EXPECT_NEAR(std::fabs(back[1][0].value[3].get<double>()), 1, 1e-12);
}

TEST(Wedges, a_grid_is_all_pairs_row_by_row) {
  const Wedge wedge = wedge_of(R"([{"path": "/a", "values": ["x", "y"], "label": "letter", "labels": ["X", "Y"]},
                                   {"path": "/b", "range": {"from": 1, "to": 3, "count": 3}}])");
  ASSERT_EQ(wedge.size(), 6U);
  EXPECT_EQ(wedge[4][0].value, "y");
  EXPECT_EQ(wedge[4][1].value, 2.0);
  EXPECT_EQ(wedge.values_json(4), Json::parse(R"([{"path": "/a", "label": "letter", "text": "Y", "value": "y"},
                            {"path": "/b", "label": "", "text": "2", "value": 2.0}])"));
  EXPECT_EQ(wedge.axes_json()[1]["texts"], Json({"1", "2", "3"}));
  EXPECT_NE(refusal_of(R"({"wedge": [{"path": "/a", "values": [1]}, {"path": "/a", "values": [1]}]})"), "");
  EXPECT_NE(refusal_of(R"({"wedge": []})"), "");
  EXPECT_NE(refusal_of(R"({"wedge": [{"path": "/a", "range": {"from": 0, "to": 1, "count": 1000000}},
                                     {"path": "/b", "range": {"from": 0, "to": 1, "count": 1000000}}]})"),
            "");
  EXPECT_NE(refusal_of(R"({"wedge": {"path": "/a", "values": [1, 2], "labels": ["one"]}})"), "");
}

TEST(Wedges, set_members_that_are_known_and_absent) {
  const Journal journal = journal_of(
      R"({"wedge": {"path": "/scene/extras/relook/environment/image", "values": ["WoodImage"]}},{"edit": []})");
  SceneState state = small_state();
  ASSERT_FALSE(state.document().look.contains("/scene/extras/relook/environment/image"_json_pointer));
  EXPECT_EQ(message_of([&] { static_cast<void>(check_journal(state, journal)); }), "");
  EXPECT_NE(message_of([&] {
              static_cast<void>(check_journal(state, journal_of(R"({"wedge": {"path": "/scene/sky", "values": [1]}})")));
            }),
            "");
}

TEST(Wildcards, stand_for_any_characters) {
  EXPECT_TRUE(matches_wildcard("Leaves*", "Leaves"));
  EXPECT_TRUE(matches_wildcard("*a*b*", "xxaxxb"));
  EXPECT_TRUE(matches_wildcard("*", ""));
  EXPECT_FALSE(matches_wildcard("a*b", "abc"));
  EXPECT_FALSE(matches_wildcard("", "a"));
  EXPECT_TRUE(matches_wildcard("a*a*a", "aaaa"));
}

TEST(Wildcards, replace_in_every_entry_that_they_match) {
  SceneState state = small_state();
  apply_json(state,
             R"([{"op": "replace", "path": "/materials/G*/pbrMetallicRoughness/roughnessFactor", "value": 0.125}])");
  for (const auto& [name, material] : state.document().look["materials"].items())
    EXPECT_EQ(material["pbrMetallicRoughness"]["roughnessFactor"] == 0.125, name.starts_with("G")) << name;
  EXPECT_EQ(
      message_of([&] { apply_json(state, R"([{"op": "replace", "path": "/materials/X*/alphaCutoff", "value": 1}])"); }),
      R"(j.json: /edit/0/path: no material matches "X*")");
  apply_json(state, R"([{"op": "add", "path": "/materials/G*", "value": {}},
                        {"op": "replace", "path": "/materials/G*/alphaCutoff", "value": 0.75}])");
  EXPECT_EQ(state.document().look["materials"]["G*"]["alphaCutoff"], 0.75);
  EXPECT_EQ(state.document().look["materials"]["Gold"]["alphaCutoff"], 0.5);
}

}  // namespace
}  // namespace relook
