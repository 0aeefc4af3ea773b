// The strict reader of journal/1: what it accepts, and the exact message for everything it refuses.
#include "edit/journal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/files.h"
#include "look_fixture.h"

namespace relook {
namespace {

class JournalFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("relook_journal_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    path_ = folder_ / "gold.json";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Journal read(const std::string& text) {
    write_file(path_, text);
    return read_journal(path_);
  }
  /// The message for a journal with these steps, without the file's name.
  std::string refusal(const std::string& steps) {
    return refusal_of(R"({"relook": "journal/1", "steps": )" + steps + "}");
  }
  std::string refusal_of(const std::string& text) {
    const std::string message = message_of([&] { (void)read(text); });
    const std::string prefix = path_.string() + ": ";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
  }

  std::filesystem::path folder_, path_;
};

TEST_F(JournalFile, reads_steps_edits_and_drags) {
  const Journal journal = read(R"({"relook": "journal/1", "steps": [
    {"name": "a", "edit": [{"op": "replace", "path": "/materials/Gold/alphaCutoff", "value": 0.25},
                           {"op": "move", "from": "/nodes/A", "path": "/nodes/B"}]},
    {"select": ["/nodes/A"], "drag": [[{"op": "test", "path": "/x", "value": null}], []]}]})");
  EXPECT_EQ(journal.name, "gold");
  EXPECT_EQ(journal.file, path_.string());
  EXPECT_EQ(journal.hash.size(), 32U);
  ASSERT_EQ(journal.steps.size(), 2U);
  EXPECT_EQ(journal.steps[0].name, "a");
  ASSERT_EQ(journal.steps[0].edit.size(), 2U);
  EXPECT_EQ(journal.steps[0].edit[0].op, PatchOp::replace);
  EXPECT_EQ(journal.steps[0].edit[0].value, 0.25);
  EXPECT_EQ(journal.steps[0].edit[1].from, "/nodes/A");
  EXPECT_EQ(journal.steps[0].edit[1].where, "/steps/0/edit/1");
  EXPECT_EQ(journal.steps[1].name, "step 2");
  EXPECT_EQ(journal.steps[1].select, (std::vector<std::string>{"/nodes/A"}));
  ASSERT_EQ(journal.steps[1].drag.size(), 2U);
  EXPECT_EQ(journal.steps[1].drag[0][0].where, "/steps/1/drag/0/0");
}

TEST_F(JournalFile, reads_wedges_as_one_edit_a_value) {
  const Journal journal = read(R"({"relook": "journal/1", "steps": [
    {"wedge": {"path": "/lights/Key/intensity", "values": [10, 20]}},
    {"wedge": {"path": "/lights/Key/color", "range": {"from": [0, 1, 0.5], "to": [1, 0, 0.5], "count": 3}}}]})");
  ASSERT_EQ(journal.steps.size(), 2U);
  ASSERT_EQ(journal.steps[0].wedge.size(), 2U);
  const Edit edit = journal.steps[0].wedge[1];
  const PatchOperation& second = edit.at(0);
  EXPECT_EQ(second.op, PatchOp::replace);
  EXPECT_EQ(second.path, "/lights/Key/intensity");
  EXPECT_EQ(second.value, 20);
  EXPECT_EQ(second.value_where, "/steps/0/wedge/values/1");
  ASSERT_EQ(journal.steps[1].wedge.size(), 3U);
  EXPECT_EQ(journal.steps[1].wedge[0][0].value, Json({0.0, 1.0, 0.5}));
  EXPECT_EQ(journal.steps[1].wedge[1][0].value, Json({0.5, 0.5, 0.5}));
  EXPECT_EQ(journal.steps[1].wedge[2][0].value, Json({1.0, 0.0, 0.5}));
}

TEST_F(JournalFile, refuses_what_is_no_wedge) {
  const auto wedge = [&](const std::string& text) { return refusal("[{\"wedge\": " + text + "}]"); };
  EXPECT_EQ(wedge(R"({"path": "/a"})"), "/steps/0/wedge: a wedge has either \"values\" or \"range\"");
  EXPECT_EQ(wedge(R"({"path": "/a", "values": []})"), "/steps/0/wedge/values: expected at least one value");
  EXPECT_NE(wedge(R"({"path": "/a", "range": {"from": 0, "to": 1, "count": 1}})").find("/steps/0/wedge/range/count"),
            std::string::npos);
  EXPECT_EQ(wedge(R"({"path": "/a", "range": {"from": [0, 1], "to": [1], "count": 2}})"),
            "/steps/0/wedge/range/to: expected as many numbers as in \"from\"");
  EXPECT_EQ(refusal(R"([{"wedge": {"path": "/a", "values": [1]}, "edit": []}])"),
            "/steps/0: a step with \"wedge\" has no other edits");
}

TEST_F(JournalFile, an_empty_journal_is_fine) {
  EXPECT_TRUE(read(R"({"relook": "journal/1", "steps": []})").steps.empty());
}

TEST(LookPatch, is_a_bare_patch) {
  const Edit edit = parse_patch(R"([{"op": "remove", "path": "/nodes/A"}])", "p.json");
  ASSERT_EQ(edit.size(), 1U);
  EXPECT_EQ(edit[0].where, "/0");
}

TEST_F(JournalFile, refuses_what_is_no_journal) {
  EXPECT_EQ(refusal_of("[]"), "must be an object");
  EXPECT_EQ(refusal_of(R"({"steps": []})"), "\"relook\" is missing");
  EXPECT_EQ(refusal_of(R"({"relook": "journal/1"})"), "\"steps\" is missing");
  EXPECT_EQ(refusal_of(R"({"relook": "journal/2", "steps": []})"),
            "/relook: \"journal/2\" is not one of \"journal/1\"; did you mean \"journal/1\"?");
  EXPECT_EQ(refusal_of(R"({"relook": "journal/1", "step": []})"), "unknown key \"step\"; did you mean \"steps\"?");
  EXPECT_EQ(refusal("{}"), "/steps: must be an array");
}

TEST_F(JournalFile, refuses_steps_without_one_meaning) {
  EXPECT_EQ(refusal("[{}]"), "/steps/0: a step needs \"edit\", \"wedge\", or \"select\" and \"drag\"");
  EXPECT_EQ(refusal(R"([{"edit": [], "drag": [[]]}])"),
            "/steps/0: a step has either \"edit\" or \"select\" and \"drag\"");
  EXPECT_EQ(refusal(R"([{"drag": [[]]}])"), "/steps/0: \"select\" is missing");
  EXPECT_EQ(refusal(R"([{"select": ["/nodes/A"]}])"), "/steps/0: \"drag\" is missing");
  EXPECT_EQ(refusal(R"([{"select": ["/nodes/A"], "drag": []}])"), "/steps/0/drag: a drag needs at least one entry");
  EXPECT_EQ(refusal(R"([{"select": [], "drag": [[]]}])"), "/steps/0/select: a drag needs at least one selected node");
  EXPECT_EQ(refusal(R"([{"select": ["/materials/A"], "drag": [[]]}])"),
            "/steps/0/select/0: expected \"/nodes/<name>\"");
  EXPECT_EQ(refusal(R"([{"select": ["/nodes/A", "/nodes/A"], "drag": [[]]}])"), "/steps/0/select/1: selected twice");
  EXPECT_EQ(refusal(R"([{"name": 3, "edit": []}])"), "/steps/0/name: must be a string");
  EXPECT_EQ(refusal(R"([{"wdge": [], "edit": []}])"), "/steps/0: unknown key \"wdge\"; did you mean \"wedge\"?");
}

TEST_F(JournalFile, refuses_operations_that_are_not_rfc_6902) {
  EXPECT_EQ(refusal(R"([{"edit": {}}])"), "/steps/0/edit: must be an array");
  EXPECT_EQ(refusal(R"([{"edit": [{"path": "/a"}]}])"), "/steps/0/edit/0: \"op\" is missing");
  EXPECT_TRUE(refusal(R"([{"edit": [{"op": "repalce", "path": "/a", "value": 1}]}])")
                  .starts_with("/steps/0/edit/0/op: \"repalce\" is not one of"));
  EXPECT_TRUE(
      refusal(R"([{"edit": [{"op": "repalce", "path": "/a", "value": 1}]}])").ends_with("did you mean \"replace\"?"));
  EXPECT_EQ(refusal(R"([{"edit": [{"op": "remove"}]}])"), "/steps/0/edit/0: \"path\" is missing");
  EXPECT_EQ(refusal(R"([{"edit": [{"op": "add", "path": "/a"}]}])"), "/steps/0/edit/0: \"value\" is missing");
  EXPECT_EQ(refusal(R"([{"edit": [{"op": "move", "path": "/a"}]}])"), "/steps/0/edit/0: \"from\" is missing");
  EXPECT_EQ(refusal(R"([{"edit": [{"op": "remove", "path": "/a", "value": 1}]}])"),
            "/steps/0/edit/0: unknown key \"value\"");
  EXPECT_EQ(refusal(R"([{"edit": [{"op": "remove", "path": "a"}]}])"),
            "/steps/0/edit/0/path: a JSON pointer starts with \"/\"");
  EXPECT_EQ(refusal(R"([{"edit": [{"op": "remove", "path": "/a~2"}]}])"),
            "/steps/0/edit/0/path: \"~\" must be followed by 0 or 1");
  EXPECT_EQ(refusal(R"([{"edit": [{"op": "remove", "path": 3}]}])"), "/steps/0/edit/0/path: must be a string");
}

TEST_F(JournalFile, names_every_wrong_step) {
  const std::string line = ": a step needs \"edit\", \"wedge\", or \"select\" and \"drag\"";
  EXPECT_EQ(message_of([&] {
              (void)parse_journal(
                  R"({"relook": "journal/1", "steps": [{}, {"edit": []}, {"name": 3, "edit": []}, {}]})", "j.json");
            }),
            "j.json: /steps/0" + line + "\nj.json: /steps/2/name: must be a string\nj.json: /steps/3" + line);
  const auto lines_of_wrong_steps = [&](std::size_t steps) {
    std::string text = R"({"relook": "journal/1", "steps": [{})", expected = "j.json: /steps/0" + line;
    for (std::size_t i = 1; i < steps; ++i) text += ", {}";
    for (std::size_t i = 1; i < steps && i < 20; ++i) expected += "\nj.json: /steps/" + std::to_string(i) + line;
    return std::pair{message_of([&] { (void)parse_journal(text + "]}", "j.json"); }), expected};
  };
  for (const auto& [steps, rest] :
       {std::pair{20, ""}, {21, "\nj.json: 1 more step is wrong"}, {1000, "\nj.json: 980 more steps are wrong"}}) {
    const auto [message, expected] = lines_of_wrong_steps(static_cast<std::size_t>(steps));
    EXPECT_EQ(message, expected + rest);
  }
}

TEST_F(JournalFile, keeps_its_bytes) {
  const std::string text = " {\"relook\": \"journal/1\",\n\"steps\": []}\n";
  EXPECT_EQ(read(text).text, text);
}

// A name that led to the run folder itself or out of it.
TEST(JournalName, is_one_safe_component_of_a_path) {
  const std::string text = R"({"relook": "journal/1", "steps": []})";
  const std::string accents = [] {
    std::string name;
    for (int i = 0; i < 110; ++i) name += "\xc3\xa9";
    return name;
  }();
  for (const auto& [file, name] : {std::pair<std::string, std::string>{"night.json", "night"},
                                   {"a/b/night.v2.json", "night.v2"},
                                   {"night.journal", "night"},
                                   {"night", "night"},
                                   {"...json", "journal"},
                                   {"a/..json", "journal"},
                                   {".json", "journal"},
                                   {"../....json", "..."},
                                   {"....", "..."},
                                   {"...", "journal"},
                                   {"..", "journal"},
                                   {"a/", "journal"},
                                   {"", "journal"},
                                   {std::string(250, 'x') + ".json", std::string(200, 'x')},
                                   {"x" + accents + ".json", "x" + accents.substr(0, 198)}}) {
    EXPECT_EQ(parse_journal(text, file).name, name) << file;
  }
}

TEST_F(JournalFile, refuses_json_that_says_two_things) {
  EXPECT_NE(refusal(R"([{"name": "a", "name": "b", "edit": []}])").find("twice"), std::string::npos);
  EXPECT_NE(refusal(R"([{"edit": [{"op": "add", "path": "/a", "value": 1e999}]}])"), "");
}

TEST_F(JournalFile, a_missing_file_is_named) {
  EXPECT_NE(message_of([&] { (void)read_journal(folder_ / "none.json"); }).find("none.json"), std::string::npos);
}

}  // namespace
}  // namespace relook
