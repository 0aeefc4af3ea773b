// "-" names standard input wherever a journal or a look patch is read.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kSpheres = std::filesystem::path(RELOOK_SOURCE_DIR) / "scenes/spheres";

constexpr const char* kJournal = R"({"relook": "journal/1", "steps": [
  {"edit": [{"op": "replace", "path": "/lights/Lamp/intensity", "value": 40}]},
  {"edit": [{"op": "add", "path": "/images/New", "value": {"uri": "new.png"}}]}]})";

class StandardInput : public testing::Test {
 protected:
  void SetUp() override {
    for (const auto& entry : std::filesystem::directory_iterator(kSpheres / "textures"))
      if (entry.path().extension() == ".png")
        std::filesystem::copy_file(entry.path(), folder_ / "new.png",
                                   std::filesystem::copy_options::overwrite_existing);
    write_file(folder_ / "j.json", std::string_view(kJournal));
    ASSERT_EQ(relook("preprocess \"$SCENE\" -o c --resolution 64x36 --quiet").exit_code, 0);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  /// `arguments` with redirections and pipes, in the folder; `before` comes before the program's name.
  [[nodiscard]] ProgramResult relook(const std::string& arguments, const std::string& before = "") const {
    return run_program({"sh", "-c", "cd \"$1\" && SCENE=\"$2\" && " + before + " \"$3\" " + arguments, "sh", at(""),
                        (kSpheres / "spheres.gltf").string(), RELOOK_PROGRAM});
  }
  void expect_error(const ProgramResult& result, int exit_code, const std::string& line) const {
    EXPECT_EQ(result.exit_code, exit_code) << result.output;
    EXPECT_EQ(result.output, "relook: " + line + "\n");
  }
  void expect_equal_files(const std::string& a, const std::string& b) const {
    EXPECT_EQ(read_file(at(a)), read_file(at(b))) << a << " " << b;
  }

  ScratchFolder folder_{"standard_input"};
};

TEST_F(StandardInput, is_a_journal_for_each_verb_that_takes_one) {
  for (const auto& [input, run] : {std::pair{"j.json", "a"}, {"-", "b"}}) {
    const std::string journal(input), out(run);
    const ProgramResult replayed = relook("replay c " + journal + " -o " + out + " --quiet", "cat j.json |");
    ASSERT_EQ(replayed.exit_code, 0) << replayed.output;
    const ProgramResult rendered =
        relook("render \"$SCENE\" -o " + out + ".exr --resolution 64x36 --quiet --journal " + journal + " <j.json");
    ASSERT_EQ(rendered.exit_code, 0) << rendered.output;
    ASSERT_EQ(relook("inspect " + journal + " --scene c --json <j.json >" + out + ".inspect").exit_code, 0);
    ASSERT_EQ(relook("plan c " + journal + " --progress none <j.json >" + out + ".plan").exit_code, 0);
  }
  for (const char* name : {"/frames/0000.exr", "/frames/0001.exr", "/frames/0002.exr", ".exr"})
    expect_equal_files("a" + std::string(name), "b" + std::string(name));
  EXPECT_NE(text_of(read_file(at("b.inspect"))).find("\"journal\": \"stdin\""), std::string::npos);
  EXPECT_NE(text_of(read_file(at("b.plan"))).find("2 frames"), std::string::npos);
}

TEST_F(StandardInput, is_a_look_patch) {
  write_file(folder_ / "p.json", R"([{"op": "replace", "path": "/lights/Lamp/intensity", "value": 3}])");
  const std::string render = "render \"$SCENE\" --resolution 64x36 --quiet ";
  ASSERT_EQ(relook(render + "-o a.exr --look p.json").exit_code, 0);
  ASSERT_EQ(relook(render + "-o b.exr --look - <p.json").exit_code, 0);
  expect_equal_files("a.exr", "b.exr");
}

TEST_F(StandardInput, is_called_stdin_in_messages) {
  const std::string replay = "replay c - -o run --quiet";
  expect_error(relook(replay, "echo '{\"relook\": \"journal/1\", \"steps\": [{}]}' |"), 2,
               "stdin: /steps/0: a step needs \"edit\", \"wedge\", or \"select\" and \"drag\"");
  expect_error(relook(replay + " </dev/null"), 2, "stdin: byte 0: is empty");
  expect_error(relook(replay + " <&-"), 2, "stdin: byte 0: is empty");
  expect_error(relook(replay + " <."), 2, "stdin: cannot read: Is a directory");
  EXPECT_FALSE(std::filesystem::exists(at("run")));
}

TEST_F(StandardInput, cannot_be_read_twice) {
  const std::string line = "\"-\" is standard input, which can be read only once";
  for (const char* arguments :
       {"replay c - - -o run", "inspect - --scene \"$SCENE\" --look -",
        "render \"$SCENE\" --journal - --look - -o x.exr", "journal diff \"$SCENE\" \"$SCENE\" --look - -o x.json"})
    expect_error(relook(std::string(arguments) + " <j.json"), 1, line);
}

}  // namespace
}  // namespace relook
