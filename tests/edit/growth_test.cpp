// A few kilobytes of journal never make gigabytes: copies within an edit and the frames of a journal are bounded.
#include "edit/growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "edit/journal_walk.h"
#include "look_fixture.h"
#include "report/edit_hashes.h"
#include "run_program.h"

namespace relook {
namespace {

/// A triangle on node N with material Paint.
const std::string kTriangle =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "N", "mesh": 0}], "materials": [{"name": "Paint"}],)"
    R"("meshes": [{"name": "T", "primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],)"
    R"("buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],)"
    R"("bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126,)"
    R"("count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]})";

std::string add(const std::string& path, const std::string& value) {
  return R"({"op": "add", "path": ")" + path + R"(", "value": )" + value + "}";
}
std::string transfer(const std::string& op, const std::string& from, const std::string& path) {
  return R"({"op": ")" + op + R"(", "from": ")" + from + R"(", "path": ")" + path + R"("})";
}
std::string step_of(const std::vector<std::string>& operations) {
  std::string text;
  for (const std::string& operation : operations) text += (text.empty() ? "" : ", ") + operation;
  return R"({"edit": [)" + text + "]}";
}
std::string journal_of(const std::vector<std::string>& steps) {
  std::string text;
  for (const std::string& step : steps) text += (text.empty() ? "" : ",\n") + step;
  return R"({"relook": "journal/1", "steps": [)" + text + "]}";
}
std::string range_wedge(const std::string& path, std::size_t count) {
  return R"({"wedge": {"path": ")" + path + R"(", "range": {"from": 0.1, "to": 0.9, "count": )" +
         std::to_string(count) + "}}}";
}
Journal parsed(const std::vector<std::string>& steps) { return parse_journal(journal_of(steps), "j.json"); }

/// What a journal on small_state() is refused with, with the document as before.
std::string refusal_of_steps(const std::vector<std::string>& steps) {
  SceneState state = small_state();
  const Json look = state.document().look;
  const std::string scene = scene_text(state.scene());
  const Journal journal = parsed(steps);
  const std::string message = message_of([&] { (void)check_journal(state, journal); });
  EXPECT_EQ(state.document().look, look);
  EXPECT_EQ(scene_text(state.scene()), scene);
  return message;
}

const std::string kGold = "/materials/Gold/extras/";
const std::string kMostCopiedText =
    "\"copy\" may make 1000000 values and 33554432 bytes of text in a journal, and no more";
const std::string kMostInEntryText =
    "\"copy\" may make an entry of 100000 values and 4194304 bytes of text, and no more";

TEST(Growth, copies_into_themselves_end_where_values_would_lie_too_deep) {
  std::vector<std::string> operations{add(kGold + "a", R"({"b": 1})")};
  for (int i = 0; i < 5000; ++i) operations.push_back(transfer("copy", kGold + "a", kGold + "a/b"));
  EXPECT_EQ(refusal_of_steps({step_of(operations)}),
            "j.json: /steps/0/edit/59/path: this would nest values deeper than 64 levels");
}

TEST(Growth, moves_and_adds_end_where_values_would_lie_too_deep) {
  const std::string deep = std::string(40, '[') + std::string(40, ']');
  std::string below = kGold + "a";
  for (int i = 0; i < 39; ++i) below += "/0";
  EXPECT_EQ(refusal_of_steps({step_of(
                {add(kGold + "a", deep), add(kGold + "b", deep), transfer("move", kGold + "b", below + "/0")})}),
            "j.json: /steps/0/edit/2/path: this would nest values deeper than 64 levels");
  EXPECT_EQ(refusal_of_steps({step_of({add(kGold + "a", deep), add(below + "/-", deep)})}),
            "j.json: /steps/0/edit/1/value: this would nest values deeper than 64 levels");
  EXPECT_EQ(
      refusal_of_steps({step_of({add(kGold + "a", deep), R"({"op": "replace", "path": ")" + below + R"(", "value": )" +
                                                             std::string(40, '[') + std::string(40, ']') + "}"})}),
      "j.json: /steps/0/edit/1/value: this would nest values deeper than 64 levels");
}

TEST(Growth, doubling_copies_end_at_what_an_entry_may_have) {
  std::vector<std::string> values{add(kGold + "a", "[0]")},
      text{add(kGold + "a", "[\"" + std::string(1000, 'x') + "\"]")};
  for (int i = 0; i < 30; ++i) {
    const std::string copy = transfer("copy", kGold + "a", kGold + "a/-");
    values.push_back(copy);
    text.push_back(copy);
  }
  EXPECT_EQ(refusal_of_steps({step_of(values)}), "j.json: /steps/0/edit/16/path: " + kMostInEntryText);
  EXPECT_EQ(refusal_of_steps({step_of(text)}), "j.json: /steps/0/edit/13/path: " + kMostInEntryText);
}

TEST(Growth, copies_of_entries_end_at_what_a_journal_may_copy) {
  std::vector<std::string> steps{step_of({add("/materials/Gold/name", "\"" + std::string(2U << 20U, 'x') + "\"")})};
  for (int i = 0; i < 30; ++i) steps.push_back(step_of({transfer("copy", "/materials/Gold", "/materials/G")}));
  const std::string message = refusal_of_steps(steps);
  EXPECT_EQ(message, "j.json: /steps/16/edit/0/path: " + kMostCopiedText);
}

TEST(Growth, a_tree_of_nodes_copied_below_itself_is_counted_before_it_is_copied) {
  std::vector<std::string> operations{add("/nodes/A", R"({"children": []})")};
  for (int i = 0; i < 40; ++i) {
    const std::string copy = "/nodes/C" + std::to_string(i);
    operations.push_back(transfer("copy", "/nodes/A", copy));
    operations.push_back(add("/nodes/A/children/-", "\"C" + std::to_string(i) + "\""));
  }
  const std::string message = refusal_of_steps({step_of(operations)});
  EXPECT_TRUE(message.starts_with("j.json: /steps/0/edit/")) << message;
  EXPECT_TRUE(message.ends_with("/path: " + kMostCopiedText)) << message;
}

TEST(Growth, what_was_wrong_before_is_said_with_the_limit) {
  const std::string wrong = step_of({R"({"op": "remove", "path": "/nodes/Nobody"})"});
  std::vector<std::string> operations{add(kGold + "a", "[0]")};
  for (int i = 0; i < 30; ++i) operations.push_back(transfer("copy", kGold + "a", kGold + "a/-"));
  EXPECT_EQ(refusal_of_steps({wrong, step_of(operations), wrong}),
            "j.json: /steps/0/edit/0/path: no node \"Nobody\"\nj.json: /steps/1/edit/16/path: " + kMostInEntryText);
}

TEST(Growth, usual_copies_are_no_growth) {
  std::vector<std::string> steps;
  for (int i = 0; i < 1000; ++i) steps.push_back(step_of({transfer("copy", "/materials/Gold", "/materials/Glass")}));
  EXPECT_EQ(refusal_of_steps(steps), "");
}

TEST(Growth, a_journal_has_a_million_frames_at_most) {
  const std::string lights = "/lights/Bulb/intensity",
                    sentence = "with this the journal has more than 1000000 frames, the most that one may have";
  const auto refused = [&](const std::vector<std::string>& steps) { return message_of([&] { (void)parsed(steps); }); };
  EXPECT_EQ(refused({range_wedge(lights, 1'000'000)}), "");
  EXPECT_EQ(refused({range_wedge(lights, 1'000'001)}), "j.json: /steps/0/wedge/range/count: " + sentence);
  EXPECT_EQ(refused({range_wedge(lights, 999'999), R"({"edit": []})"}), "");
  EXPECT_EQ(refused({range_wedge(lights, 1'000'000), R"({"edit": []})"}), "j.json: /steps/1: " + sentence);
  EXPECT_EQ(refused(std::vector<std::string>(300, range_wedge(lights, 10'000))),
            "j.json: /steps/100/wedge/range/count: " + sentence);
  EXPECT_EQ(refused({range_wedge(lights, 999'999), R"({"select": ["/nodes/A"], "drag": [[], []]})"}),
            "j.json: /steps/1/drag: " + sentence);
  EXPECT_EQ(refused({range_wedge(lights, 999'999), R"({"wedge": {"path": "/a", "values": [1, 2]}})"}),
            "j.json: /steps/1/wedge/values: " + sentence);
}

TEST(Growth, values_between_are_no_longer_than_a_matrix) {
  std::string numbers = "[0";
  for (int i = 1; i < 17; ++i) numbers += ",0";
  numbers += "]";
  EXPECT_EQ(message_of([&] {
              (void)parsed({R"({"wedge": {"path": "/a", "range": {"from": )" + numbers + R"(, "to": )" + numbers +
                            R"(, "count": 2}}})"});
            }),
            "j.json: /steps/0/wedge/range/from: expected at most 16 numbers");
}

/// The program within 512 MB of address space.
class GrowthProgram : public ::testing::Test {
 protected:
  ProgramResult inspect(const std::string& journal, const std::vector<std::string>& more) {
    const std::string path = (folder_ / "j.json").string();
    std::ofstream(folder_ / "scene.gltf") << kTriangle;
    std::ofstream(path) << journal;
    std::vector<std::string> command{"sh", "-c",     "ulimit -v 524288; exec \"$0\" \"$@\"", RELOOK_PROGRAM, "inspect",
                                     path, "--quiet"};
    command.insert(command.end(), more.begin(), more.end());
    return run_program(command);
  }
  const ScratchFolder folder_{"growth"};
  const std::string scene_ = (folder_ / "scene.gltf").string();
};

TEST_F(GrowthProgram, a_wedge_of_a_million_frames_takes_little_memory) {
  const ProgramResult result =
      inspect(journal_of({range_wedge("/materials/Paint/pbrMetallicRoughness/roughnessFactor", 1'000'000)}), {});
  EXPECT_EQ(result.exit_code, 0) << result.output.substr(0, 500);
}

TEST_F(GrowthProgram, frames_on_a_scene_are_checked_without_being_kept) {
  const ProgramResult result = inspect(
      journal_of({range_wedge("/materials/Paint/pbrMetallicRoughness/roughnessFactor", 20'000)}), {"--scene", scene_});
  EXPECT_EQ(result.exit_code, 0) << result.output.substr(0, 500);
}

TEST_F(GrowthProgram, a_drag_of_a_million_entries_takes_little_memory) {
  std::string entries = "[]";
  for (int i = 1; i < 1'000'000; ++i) entries += ",[]";
  const std::string drag = R"({"select": ["/nodes/N"], "drag": [)";
  EXPECT_EQ(inspect(journal_of({drag + entries + "]}"}), {}).exit_code, 0);
  const ProgramResult result = inspect(journal_of({drag + entries + ",[]]}"}), {});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.output.find("/steps/0/drag: with this the journal has more"), std::string::npos) << result.output;
}

TEST_F(GrowthProgram, doubling_copies_are_refused_with_one_line) {
  std::vector<std::string> operations{add("/nodes/N/extras", R"({"a": [")" + std::string(1000, 'x') + R"("]})")};
  for (int i = 0; i < 40; ++i) operations.push_back(transfer("copy", "/nodes/N/extras/a", "/nodes/N/extras/a/-"));
  const ProgramResult result = inspect(journal_of({step_of(operations)}), {"--scene", scene_});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  EXPECT_NE(result.output.find("/steps/0/edit/13/path: " + kMostInEntryText), std::string::npos) << result.output;
}

TEST_F(GrowthProgram, many_wedges_and_operations_are_refused_with_one_line) {
  const std::string operation = add("/materials/Paint/extras/x", "1");
  std::vector<std::string> steps;
  for (int i = 0; i < 200; ++i) {
    steps.push_back(range_wedge("/materials/Paint/pbrMetallicRoughness/roughnessFactor", 10'000));
    steps.push_back(step_of(std::vector<std::string>(20, operation)));
  }
  const ProgramResult result = inspect(journal_of(steps), {"--scene", scene_});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  EXPECT_NE(result.output.find("/steps/198/wedge/range/count: with this"), std::string::npos) << result.output;
}

TEST_F(GrowthProgram, what_is_inspected_as_json_is_one_document) {
  const ProgramResult result =
      inspect(journal_of({range_wedge("/materials/Paint/pbrMetallicRoughness/roughnessFactor", 3), R"({"edit": []})"}),
              {"--json", "--scene", scene_});
  const std::size_t begin = result.output.find('{');
  ASSERT_NE(begin, std::string::npos) << result.output;
  const Json json = Json::parse(result.output.substr(begin));
  EXPECT_EQ(json.at("steps").size(), 4U);
  EXPECT_EQ(json.at("steps")[2].at("wedge_frame"), 3);
  EXPECT_EQ(json.dump(2) + "\n", result.output.substr(begin));
}

}  // namespace
}  // namespace relook
