// `relook schema`: valid schemas; what they refuse, the program refuses; journals that are kept pass. The validator is
// Python's jsonschema; where it is not installed, these tests skip and say so.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "cli_fixture.h"
#include "edit/apply.h"
#include "gltf_writer.h"
#include "look_fixture.h"

namespace relook {
namespace {

namespace fs = std::filesystem;
const fs::path kSources = RELOOK_SOURCE_DIR;

class SchemaVerb : public Cli {
 protected:
  void SetUp() override {
    const ProgramResult known = run_program({"python3", "-c", "import jsonschema"});
    if (known.exit_code != 0)
      GTEST_SKIP() << "no jsonschema for Python (apt-get install python3-jsonschema): schemas are NOT tested";
  }
  /// Writes a schema, and returns its file.
  std::string schema(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "schema");
    const ProgramResult result = relook(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    const std::string file = at("schema" + std::to_string(count_++) + ".json");
    write_text(file, result.output);
    return file;
  }
  /// A line a file: "ok" or what is refused.
  static std::vector<std::string> validated(const std::string& schema, const std::vector<std::string>& files) {
    std::vector<std::string> command{"python3", (kSources / "tests/cli/validate.py").string(), schema};
    command.insert(command.end(), files.begin(), files.end());
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    std::istringstream text(result.output);
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    EXPECT_EQ(lines.size(), files.size()) << result.output;
    lines.resize(files.size());
    return lines;
  }
  std::string journal(const std::string& steps) const {
    const std::string file = at("journal" + std::to_string(count_++) + ".json");
    write_text(file, R"({"relook": "journal/1", "steps": [)" + steps + "]}");
    return file;
  }

 private:
  mutable int count_ = 0;
};

TEST_F(SchemaVerb, passes_all_journals_of_the_project) {
  std::vector<std::string> files;
  for (const fs::path& folder : {kSources / "journals", kSources / "journals/assets"})
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".json") continue;
      const Json json = read_json(entry.path());
      if (json.is_object() && json.contains("steps")) files.push_back(entry.path().string());
    }
  ASSERT_GT(files.size(), 12U);
  const std::vector<std::string> lines = validated(schema({"journal"}), files);
  for (std::size_t i = 0; i < files.size(); ++i) EXPECT_EQ(lines[i], "ok") << files[i];
  const std::string of_spheres = schema({"journal", "--scene", kScene});
  EXPECT_EQ(validated(of_spheres, {(kSources / "journals/table1.json").string()}), std::vector<std::string>{"ok"});
}

TEST_F(SchemaVerb, passes_what_the_program_accepts_of_the_kept_corpus) {
  write_text(at("square.glb"), square().glb());
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(kSources / "tests/fuzz/corpus/journal")) {
    const Bytes bytes = read_file(entry.path());
    try {
      SceneState state = small_state();
      static_cast<void>(check_journal(state, parse_journal(text_of(bytes), at("j.json"))));
    } catch (const Error&) {
      continue;
    }
    files.push_back(at(entry.path().filename().string() + ".json"));
    write_text(files.back(), std::string(text_of(bytes)));
  }
  ASSERT_GT(files.size(), 3U);
  const std::vector<std::string> lines = validated(schema({"journal"}), files);
  for (std::size_t i = 0; i < files.size(); ++i) EXPECT_EQ(lines[i], "ok") << files[i];
}

// Of the scene kScene; "" where the schema of a scene is to accept, and so is the program.
TEST_F(SchemaVerb, what_it_refuses_the_program_refuses) {
  struct Case {
    const char* steps;
    bool is_right, is_right_anywhere;
  };
  const Case cases[] = {
      {R"({"name": "a", "note": "n", "author": "me", "extras": {"a": [1]}, "edit": []})", true, true},
      {R"({"edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/roughnessFactor", "value": 0.25}]})",
       true, true},
      {R"({"edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/roughnessFactor", "value": 1.25}]})",
       false, false},
      {R"({"edit": [{"op": "replace", "path": "/materials/Paint/roughnessFactor", "value": 0.25}]})", false, false},
      {R"({"edit": [{"op": "replace", "path": "/materials/Pant/alphaCutoff", "value": 0.25}]})", false, true},
      {R"({"edit": [{"op": "replace", "path": "/materials/0/alphaCutoff", "value": 0.25}]})", true, true},
      {R"({"edit": [{"op": "replace", "path": "/materials/P*t/alphaCutoff", "value": 0.25}]})", true, true},
      {R"({"edit": [{"op": "replace", "path": "/extensions/KHR_lights_punctual/lights/0/intensity", "value": 9}]})",
       true, true},
      {R"({"edit": [{"op": "replace", "path": "/nodes/Cube/rotation", "value": [0, 45, 0]}]})", false, false},
      {R"({"edit": [{"op": "replace", "path": "/nodes/Cube/extensions/KHR_node_visibility/visible", "value": 0}]})",
       false, false},
      {R"({"edit": [{"op": "add", "path": "/materials/New", "value": {"pbrMetallicRoughness": {"metallicFactor": 2}}}]})",
       false, false},
      {R"({"edit": [{"op": "add", "path": "/materials/New", "value": {}},
                    {"op": "replace", "path": "/materials/New/alphaCutoff", "value": 0.1}]})",
       true, true},
      {R"({"edit": [{"op": "replase", "path": "/materials/Paint/alphaCutoff", "value": 0.1}]})", false, false},
      {R"({"edit": [{"op": "remove", "path": "/nodes/Cube", "value": 1}]})", false, false},
      {R"({"wedge": {"path": "/materials/Paint/alphaCutoff", "values": [0.1, 0.2], "labels": ["a", "b"]}})", true,
       true},
      {R"({"keep": false, "wedge": {"path": "/materials/Paint/alphaCutoff", "range": {"from": 0, "to": 1, "count": 3}}})",
       true, true},
      {R"({"wedge": {"path": "/materials/Paint/alphaCutoff", "range": {"from": -1, "to": 1, "count": 3}}})", false,
       false},
      {R"({"wedge": {"path": "/materials/Paint/alphaCutoff", "range": {"from": 0, "to": 1}}})", false, false},
      {R"({"wedge": [{"path": "/materials/Paint/alphaCutoff", "values": [0.1]},
                     {"path": "/materials/Paint/pbrMetallicRoughness/roughnessFactor", "values": [0.1, 0.2]}]})",
       true, true},
      {R"({"keep": false, "edit": []})", false, false},
      {R"({"edit": [], "drag": [[]], "select": ["/nodes/Cube"]})", false, false},
      {R"({"select": ["/nodes/Cub"], "drag": [[]]})", false, true},
      {R"({"select": ["/nodes/Cube"], "drag": [[{"op": "replace", "path": "/nodes/Cube/translation", "value": [0, 1, 2]}]]})",
       true, true},
      {R"({"from": "base", "edit": []})", true, true},
      {R"({"from": -1, "edit": []})", false, false},
      {R"({"edits": []})", false, false},
      {R"({})", false, false}};
  std::vector<std::string> files;
  for (const Case& one : cases) files.push_back(journal(one.steps));
  const std::vector<std::string> of_scene = validated(schema({"journal", "--scene", kScene}), files);
  const std::vector<std::string> of_any = validated(schema({"journal"}), files);
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_EQ(of_scene[i] == "ok", cases[i].is_right) << cases[i].steps << " " << of_scene[i];
    EXPECT_EQ(of_any[i] == "ok", cases[i].is_right_anywhere) << cases[i].steps << " " << of_any[i];
    const ProgramResult result = relook({"inspect", files[i], "--scene", kScene, "--quiet"});
    EXPECT_EQ(result.exit_code, cases[i].is_right ? 0 : 2) << cases[i].steps << " " << result.output;
  }
}

TEST_F(SchemaVerb, of_reports_is_that_of_the_project) {
  EXPECT_EQ(read_json(schema({"report"})), read_json(kSources / "src/report/report.schema.json"));
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(validated(schema({"report"}), {at("run/report.json")}), std::vector<std::string>{"ok"});
  EXPECT_EQ(read_json(schema({"journal", "--scene", at("c")}))["$defs"],
            read_json(schema({"journal", "--scene", kScene}))["$defs"])
      << "a cache is as good as its scene";
}

TEST_F(Cli, schema_says_what_it_does_not_take) {
  expect_error(relook({"schema"}), 1, "KIND");
  expect_error(relook({"schema", "jornal"}), 1, "jornal");
  expect_error(relook({"schema", "report", "--scene", kScene}), 1, "report.json is of no scene");
  expect_error(relook({"schema", "journal", "--scene", at("none.glb")}), 2, "none.glb");
}

}  // namespace
}  // namespace relook
