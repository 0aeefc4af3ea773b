// The walk of a journal: its frames, their numbers and what of a step stays, over all forms of steps; and that replay,
// plan, inspect, blame, render and the hashes of edits walk the same frames.
#include "edit/journal_walk.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "look_fixture.h"
#include "report/edit_hashes.h"
#include "run_program.h"

namespace relook {
namespace {

std::string set(const std::string& path, const std::string& value) {
  return R"({"op": "replace", "path": ")" + path + R"(", "value": )" + value + "}";
}
std::string is(const std::string& path, const std::string& value) {
  return R"({"op": "test", "path": ")" + path + R"(", "value": )" + value + "}";
}

/// An edit, a drag, a wedge of values, an edit that requires what these leave, and a wedge of a range.
std::string journal_of_all_forms(const std::string& light, const std::string& node, std::size_t last_frames) {
  const std::string intensity = "/lights/" + light + "/intensity", place = "/nodes/" + node + "/translation";
  return R"({"relook": "journal/1", "steps": [{"name": "dim", "edit": [)" + set(intensity, "20") +
         R"(]}, {"name": "carry", "select": ["/nodes/)" + node + R"("], "drag": [[)" + set(place, "[-2.5, 5, 3]") +
         "], [" + set(place, "[-2, 5, 3]") + R"(]]}, {"name": "try", "wedge": {"path": ")" + intensity +
         R"(", "values": [10, 40, 25]}}, {"name": "go on", "edit": [)" + is(intensity, "25") + "," +
         is(place, "[-2, 5, 3]") + "," + set("/lights/" + light + "/color", "[1, 0.5, 0.25]") +
         R"(]}, {"name": "sweep", "wedge": {"path": ")" + intensity +
         R"(", "range": {"from": 30, "to": 60, "count": )" + std::to_string(last_frames) + "}}}]}";
}

Journal small_journal(std::size_t last_frames = 2) {
  return parse_journal(journal_of_all_forms("Bulb", "Group", last_frames), "j.json");
}

std::string kind_name(EventKind kind) {
  switch (kind) {
    case EventKind::base:
      return "base";
    case EventKind::edit:
      return "edit";
    case EventKind::drag:
      return "drag";
    case EventKind::release:
      return "release";
    case EventKind::wedge_end:
      return "wedge end";
  }
  return "";
}

/// "drag 2_01".
std::vector<std::string> lines_of(const JournalWalk& walk) {
  std::vector<std::string> lines;
  for (const JournalEvent& event : walk) lines.push_back(kind_name(event.kind) + " " + step_label(event.place));
  return lines;
}

using Lines = std::vector<std::string>;

TEST(JournalWalk, has_frames_and_ends_in_the_order_of_the_journal) {
  const Journal journal = small_journal();
  EXPECT_EQ(lines_of(JournalWalk(journal)),
            (Lines{"edit 1", "drag 2_01", "drag 2_02", "release 2_02", "edit 3_01", "edit 3_02", "edit 3_03",
                   "wedge end 3_03", "edit 4", "edit 5_01", "edit 5_02", "wedge end 5_02"}));
  EXPECT_EQ(frame_count(journal), 9U);
}

TEST(JournalWalk, goes_over_the_steps_asked_for) {
  const Journal journal = small_journal();
  EXPECT_EQ(lines_of(JournalWalk(journal, 0, 0)), Lines{"base 0"});
  EXPECT_EQ(lines_of(JournalWalk(journal, 0, 1)), (Lines{"base 0", "edit 1"}));
  EXPECT_EQ(lines_of(JournalWalk(journal, 2, 2)), (Lines{"drag 2_01", "drag 2_02", "release 2_02"}));
  EXPECT_EQ(lines_of(JournalWalk(journal, 4, 5)), (Lines{"edit 4", "edit 5_01", "edit 5_02", "wedge end 5_02"}));
  EXPECT_EQ(lines_of(JournalWalk(journal, 1, 0)), Lines());
  EXPECT_EQ(lines_of(JournalWalk(parse_journal(R"({"relook": "journal/1", "steps": []})", "j.json"))), Lines());
}

TEST(JournalWalk, single_frames_are_those_of_the_walk) {
  const Journal journal = small_journal(100);
  std::size_t frames = 0;
  for (const JournalEvent& event : JournalWalk(journal, 0, 5)) {
    const std::uint32_t step = event.place.step;
    const std::string label = step_label(event.place);
    EXPECT_EQ(step_label(place_of(journal, step, event.frame)), label);
    EXPECT_EQ(event.place.number.has_value(), is_numbered(journal, step)) << label;
    EXPECT_EQ(event.step == nullptr ? "base" : event.step->name, step_name(journal, step)) << label;
    if (event.has_frame()) ++frames;
    if (event.has_frame()) continue;
    EXPECT_EQ(label, step_label(last_place_of(journal, step)));
    EXPECT_EQ(event.frame + 1, frames_in(journal, step)) << label;
  }
  EXPECT_EQ(frames, frame_count(journal) + 1);
  EXPECT_EQ(frame_name(place_of(journal, 5, 0)), "frames/0005_001.exr");
  EXPECT_EQ(preview_name(last_place_of(journal, 5)), "previews/0005_100.png");
}

TEST(JournalWalk, a_step_starts_with_the_last_frame_of_the_one_before) {
  const Journal journal = small_journal();
  SceneState state = small_state();
  std::vector<double> intensities;
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    (void)apply_edit(state, event.edit(), journal.file, {});
    intensities.push_back(state.document().look.at("/lights/Bulb/intensity"_json_pointer).get<double>());
  });
  EXPECT_EQ(intensities, (std::vector<double>{20, 20, 20, 10, 40, 25, 25, 30, 60}));
  EXPECT_EQ(state.document().look.at("/nodes/Group/translation"_json_pointer), Json({-2, 5, 3}));
  SceneState rehearsed = small_state();
  EXPECT_TRUE(check_journal(rehearsed, journal).empty());
}

TEST(JournalWalk, a_wedge_that_ends_where_it_began_leaves_the_scene_as_it_was) {
  const Journal journal = parse_journal(
      R"({"relook": "journal/1", "steps": [{"wedge": {"path": "/lights/Bulb/intensity", "values": [5, 60, 30]}}]})",
      "j.json");
  SceneState state = small_state();
  const std::string before = scene_text(state.scene());
  std::vector<std::string> after;
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    (void)apply_edit(state, event.edit(), journal.file, {});
    after.push_back(scene_text(state.scene()));
  });
  ASSERT_EQ(after.size(), 3U);
  EXPECT_NE(after[0], before);
  EXPECT_NE(after[1], before);
  EXPECT_EQ(after[2], before);
}

TEST(JournalWalk, a_million_frames_are_walked_without_their_edits) {
  const Journal journal = parse_journal(
      R"({"relook": "journal/1", "steps": [{"wedge": {"path": "/a", "range": {"from": 0, "to": 999999, "count": 1000000}}}]})",
      "j.json");
  std::size_t events = 0;
  JournalEvent last;
  for (const JournalEvent& event : JournalWalk(journal)) {
    ++events;
    if (event.has_frame()) last = event;
  }
  EXPECT_EQ(events, 1'000'001U);
  EXPECT_EQ(step_label(last.place), "1_1000000");
  EXPECT_EQ(last.edit().at(0).value, 999999.0);
}

/// What the program says of the journal of all forms on the spheres, whose lamp lights the floor.
class JournalWalkProgram : public testing::Test {
 protected:
  static constexpr const char* kPixel = "48,52";  // of the floor: every frame changes it

  void SetUp() override {
    std::ofstream(at("j.json")) << journal_of_all_forms("Lamp", "Lamp", 3);
    journal_ = read_journal(at("j.json"));
    run({"preprocess", scene(), "--integrator", "whitted", "-o", at("cache"), "--resolution", "96x54", "--quiet"});
    run({"replay", at("cache"), at("j.json"), "-o", at("run"), "--quiet"});
    for (const JournalEvent& event : JournalWalk(journal_, 0, 5)) {
      all_.push_back(frame_name(event.place));
      if (event.kind == EventKind::edit || event.kind == EventKind::drag) edited_.push_back(all_.back());
    }
  }
  static std::string scene() {
    return (std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  static std::string run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), RELOOK_PROGRAM);
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return result.output;
  }
  static Json json_of(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    return parse_json(run(std::move(arguments)), "output");
  }
  static Lines frames_of(const Json& entries) {
    Lines frames;
    for (const Json& entry : entries) frames.push_back(entry.at("frame"));
    return frames;
  }

  ScratchFolder folder_{"journal_walk"};
  Journal journal_;
  Lines all_, edited_;  // names of frames, by event
};

TEST_F(JournalWalkProgram, replay_and_hashes_follow_it) {
  const std::string file = at("run") + "/report.json";
  const Json steps = parse_json(text_of(read_file(file)), file).at("steps");
  EXPECT_EQ(frames_of(steps), all_);
  const EditHashes hashes(journal_);
  std::size_t i = 0;
  for (const JournalEvent& event : JournalWalk(journal_, 0, 5)) {
    const Json& entry = steps.at(i++);
    const std::string label = kind_name(event.kind) + " " + step_label(event.place);
    EXPECT_EQ(entry.at("edits"), hashes.at(event.place.step, event.frame)) << label;
    EXPECT_EQ(entry.at("name"), step_name(journal_, event.place.step)) << label;
    const Json number = event.has_frame() && event.place.number ? Json(*event.place.number) : Json();
    EXPECT_EQ(entry.at("drag_frame"), event.kind == EventKind::drag ? number : Json()) << label;
    EXPECT_EQ(entry.at("wedge_frame"), event.kind == EventKind::edit ? number : Json()) << label;
    EXPECT_TRUE(std::filesystem::exists(at("run") + "/" + frame_name(event.place))) << label;
  }
}

TEST_F(JournalWalkProgram, plan_follows_it) {
  const Json plan = json_of({"plan", at("cache"), at("j.json"), "--quiet"});
  EXPECT_EQ(frames_of(plan.at("frames")), Lines(all_.begin() + 1, all_.end()));
}

TEST_F(JournalWalkProgram, inspect_follows_it) {
  const Json steps = json_of({"inspect", at("j.json"), "--scene", at("cache"), "--quiet"}).at("steps");
  Lines frames;
  for (const Json& entry : steps) {
    const std::uint32_t step = entry.at("step");
    const std::size_t number = entry.value("drag_frame", entry.value("wedge_frame", std::size_t{1}));
    frames.push_back(frame_name(place_of(journal_, step, number - 1)));
  }
  EXPECT_EQ(frames, edited_);
}

TEST_F(JournalWalkProgram, blame_follows_it) {
  const Json found = json_of({"blame", at("run"), kPixel, "--quiet"});
  EXPECT_EQ(frames_of(found.at("changes")), edited_);
}

TEST_F(JournalWalkProgram, render_follows_it) {
  for (std::uint32_t step = 0; step <= 5; ++step) {
    run({"render", scene(), "--integrator", "whitted", "-o", at("frame.exr"), "--resolution", "96x54", "--journal",
         at("j.json"), "--step", std::to_string(step), "--quiet", "--overwrite"});
    const std::string replayed = at("run") + "/" + frame_name(last_place_of(journal_, step));
    EXPECT_EQ(frame_bytes(at("frame.exr")), frame_bytes(replayed)) << step;
  }
}

}  // namespace
}  // namespace relook
