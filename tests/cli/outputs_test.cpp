// Outputs that name inputs or other people's files: whatever the verb, the option and the spelling, one line, exit code
// 1, and every file is as it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "base/files.h"
#include "base/hash.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const fs::path kSpheres = fs::path(RELOOK_SOURCE_DIR) / "scenes/spheres";

const char* const kPictureJournal = R"({"relook": "journal/1", "steps": [
  {"name": "picture", "edit": [{"op": "add", "path": "/images/New", "value": {"uri": "paint.png"}}]},
  {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                              "value": [0.1, 0.9, 0.1, 1]}]}]})";
const char* const kPatch = R"([{"op": "replace", "path": "/scene/extras/relook/ambient", "value": [0.1, 0.1, 0.1]}])";

class Outputs : public testing::Test {
 protected:
  void SetUp() override {
    fs::copy(kSpheres, at("scene"), fs::copy_options::recursive);
    fs::copy_file(fs::path(RELOOK_SOURCE_DIR) / "scenes/spheres.png", at("paint.png"));
    std::ofstream(at("j.json")) << kPictureJournal;
    std::ofstream(at("patch.json")) << kPatch;
    std::ofstream(at("mine.txt")) << "mine";
    scene_ = at("scene/spheres.gltf");
    ASSERT_EQ(
        relook({"preprocess", scene_, "-o", at("c"), "--resolution", "40x24", "--samples", "4", "--quiet"}).exit_code,
        0);
    const ProgramResult run = relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    for (const char* name : {"a.exr", "b.exr"}) fs::copy_file(at("run/frames/0001.exr"), at(name));
    ASSERT_EQ(
        relook({"replay", at("c"), at("j.json"), "-o", at("logged"), "--access-log", at("log"), "--quiet"}).exit_code,
        0);
    before_ = all_files();
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::map<std::string, std::string> all_files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(at("")))
      if (entry.is_symlink())
        files[entry.path().string()] = fs::read_symlink(entry.path()).string();
      else if (entry.is_regular_file())
        files[entry.path().string()] = hash128(read_file(entry.path()));
    return files;
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& part = "") const {
    std::string words;
    for (const std::string& word : arguments) words += " " + word;
    SCOPED_TRACE(words);
    const ProgramResult result = relook(arguments);
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
    EXPECT_TRUE(all_files() == before_) << "a file is not as it was";
  }
  /// The same file or folder in other words; links are made beside it.
  [[nodiscard]] std::vector<std::string> spellings(const std::string& path) {
    const fs::path full = path, folder = full.parent_path(), name = full.filename();
    std::vector<std::string> all{path,
                                 (folder / "." / name).string(),
                                 (folder / "x" / ".." / name).lexically_normal().string(),
                                 (folder / folder.filename() / ".." / ".." / folder.filename() / name).string(),
                                 (folder / ".." / folder.filename() / name).string(),
                                 fs::relative(full).string()};
    all.erase(all.begin() + 3);
    const std::string unique = std::to_string(hash64(bytes_of(path))) + "_" + name.string();
    const fs::path link = at("link_" + unique);
    if (!fs::exists(link)) fs::create_symlink(full, link);
    all.push_back(link.string());
    if (fs::is_regular_file(full)) {
      const fs::path hard = at("hard_" + unique);
      if (!fs::exists(hard)) fs::create_hard_link(full, hard);
      all.push_back(hard.string());
    }
    before_ = all_files();
    return all;
  }

  ScratchFolder folder_{"outputs"};
  std::string scene_;
  std::map<std::string, std::string> before_;
};

TEST_F(Outputs, never_name_an_input_in_any_spelling_even_with_overwrite) {
  const std::string journal = at("j.json"), patch = at("patch.json"), cache = at("c");
  struct Case {
    std::vector<std::string> command;
    std::vector<std::string> options;
    std::vector<std::string> inputs;
  };
  const std::vector<Case> cases{
      {{"render", scene_, "--journal", journal, "--look", patch, "--resolution", "8x8"},
       {"-o", "--trace"},
       {scene_, at("scene/spheres.bin"), journal, patch, at("paint.png")}},
      {{"preprocess", scene_, "--look", patch, "--resolution", "8x8"},
       {"-o", "--trace"},
       {scene_, at("scene/spheres.bin"), patch}},
      {{"inspect", scene_}, {"--trace"}, {scene_, at("scene/spheres.bin")}},
      {{"replay", cache, journal, "--scene", scene_},
       {"-o", "--trace", "--access-log"},
       {journal, scene_, at("paint.png"), cache, at("c/MANIFEST.json"), at("c/look.json")}},
      {{"compare", at("a.exr"), at("b.exr")}, {"-o", "--html", "--json=", "--trace"}, {at("a.exr"), at("b.exr")}},
      {{"compare", at("run"), at("logged")},
       {"--html", "--json=", "--trace"},
       {at("run/frames/0000.exr"), at("run/report.json"), at("logged/frames/0001.exr")}},
      {{"plan", cache, journal}, {"--json=", "--trace"}, {journal, at("c/MANIFEST.json"), at("c/look.json")}},
      {{"inspect", journal, "--scene", scene_}, {"--trace"}, {journal, scene_}},
      {{"check", cache}, {"--trace"}, {at("c/MANIFEST.json")}},
      {{"tune", at("log")}, {"--trace"}, {at("log")}},
      {{"blame", at("run"), "3,3"},
       {"--trace"},
       {at("run/report.json"), at("run/frames/0001.exr"), journal, at("c/look.json")}},
      {{"journal", "wedge", scene_, "/lights/Lamp/intensity", "1", "2"}, {"-o", "--trace"}, {scene_}},
      {{"journal", "diff", scene_, scene_}, {"-o"}, {scene_, at("scene/spheres.bin")}}};
  for (const Case& entry : cases)
    for (const std::string& option : entry.options)
      for (const std::string& input : entry.inputs)
        for (const std::string& spelling : spellings(input))
          for (const bool overwrites : {false, true}) {
            std::vector<std::string> command = entry.command;
            if (option != "-o" && (command[0] == "render" || command[0] == "preprocess" || command[0] == "replay" ||
                                   command[0] == "journal"))
              command.insert(command.end(), {"-o", at(command[0] == "render" ? "new.exr" : "new")});
            if (option.ends_with('='))
              command.push_back(option + spelling);
            else
              command.insert(command.end(), {option, spelling});
            if (overwrites) command.push_back("--overwrite");
            expect_refused(command);
          }
}

TEST_F(Outputs, files_of_others_are_kept_and_ours_are_replaced) {
  const std::vector<std::vector<std::string>> commands{
      {"render", scene_, "--resolution", "8x8", "-o", "x.exr"},
      {"render", scene_, "--resolution", "8x8", "-o", "x.png"},
      {"render", scene_, "--resolution", "8x8", "-o", at("new.exr"), "--trace", "x.trace"},
      {"plan", at("c"), at("j.json"), "--json=x.plan"},
      {"compare", at("a.exr"), at("b.exr"), "--json=x.compare"},
      {"compare", at("a.exr"), at("b.exr"), "--html", "x.html"},
      {"journal", "wedge", scene_, "/lights/Lamp/intensity", "1", "2", "-o", "x.journal"}};
  for (std::vector<std::string> command : commands) {
    std::string& word = *std::ranges::find_if(command, [](const std::string& text) {
      return text.starts_with("x.") || text.find("=x.") != std::string::npos;
    });
    const std::string name = word.substr(word.find("x."));
    word.replace(word.find("x."), name.size(), at(name));
    std::ofstream(at(name)) << "mine";
    before_ = all_files();
    expect_refused(command, name);
    fs::remove(at(name));
    ASSERT_EQ(relook(command).exit_code % 10, 0) << name;  // 10: compare finds a difference
    EXPECT_EQ(relook(command).exit_code % 10, 0) << name << ": our own is replaced";
    std::ofstream(at(name)) << "mine";
    command.push_back("--overwrite");
    const ProgramResult replaced = relook(command);
    EXPECT_EQ(replaced.exit_code % 10, 0) << replaced.output;
    EXPECT_NE(text_of(read_file(at(name))), "mine");
  }
}

TEST_F(Outputs, a_journal_that_was_changed_by_hand_is_the_users) {
  const std::vector<std::string> command{"journal", "wedge", scene_, "/lights/Lamp/intensity",
                                         "1",       "2",     "-o",   at("w.json")};
  ASSERT_EQ(relook(command).exit_code, 0);
  ASSERT_EQ(relook(command).exit_code, 0);
  std::string text(text_of(read_file(at("w.json"))));
  text.replace(text.rfind('2'), 1, "3");
  std::ofstream(at("w.json")) << text;
  EXPECT_EQ(relook({"inspect", at("w.json"), "--scene", scene_, "--quiet"}).exit_code, 0) << "still a journal";
  before_ = all_files();
  expect_refused(command, "w.json");
}

TEST_F(Outputs, a_frame_of_a_run_is_not_replaced_by_a_render) {
  expect_refused({"render", scene_, "--resolution", "8x8", "-o", at("run/frames/0001.exr")}, "part of the run");
  expect_refused({"compare", at("a.exr"), at("b.exr"), "--json=" + at("run/report.json")}, "report.json");
}

TEST_F(Outputs, only_suffixes_that_we_write_are_taken) {
  for (const char* name : {"x.tif", "x.jpg", "x", "x.exr.bak", "x.hdr", ".exr"})
    expect_refused({"render", scene_, "--resolution", "8x8", "-o", at(name)}, "-o");
  ASSERT_EQ(relook({"render", scene_, "--resolution", "8x8", "-o", at("x.PNG"), "--quiet"}).exit_code, 0);
  EXPECT_TRUE(text_of(read_file(at("x.PNG"))).starts_with("\x89PNG"));
}

TEST_F(Outputs, folders_devices_and_links_to_nothing_are_refused) {
  fs::create_directory(at("folder.exr"));
  ASSERT_EQ(run_program({"mkfifo", at("pipe.exr")}).exit_code, 0);
  fs::create_symlink(at("nowhere"), at("dangling.exr"));
  fs::create_symlink("/dev/null", at("null.exr"));
  before_ = all_files();
  for (const char* name : {"folder.exr", "pipe.exr", "dangling.exr", "null.exr"})
    for (const bool overwrites : {false, true}) {
      std::vector<std::string> command{"render", scene_, "--resolution", "8x8", "-o", at(name)};
      if (overwrites) command.push_back("--overwrite");
      expect_refused(command, name);
    }
  expect_refused({"check", at("c"), "--trace", "/dev/null"}, "/dev/null");
}

TEST_F(Outputs, two_outputs_are_two_files) {
  expect_refused({"render", scene_, "--resolution", "8x8", "-o", at("x.exr"), "--trace", at("./x.exr")}, "too");
  expect_refused({"compare", at("a.exr"), at("b.exr"), "--json=" + at("x"), "--html", at("x")}, "too");
  expect_refused({"replay", at("c"), at("j.json"), "-o", at("r"), "--trace", at("r/report.json")}, "file of the run");
  expect_refused({"replay", at("c"), at("j.json"), "-o", at("r"), "--access-log", at("r/frames/0000.exr")},
                 "file of the run");
}

}  // namespace
}  // namespace relook
