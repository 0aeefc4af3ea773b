// Standard descriptors that are closed when the program starts: no file that it writes gets their numbers, and with
// them what is printed. Every verb, with every choice of them closed, writes what it writes undisturbed.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "base/files.h"
#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kSource = RELOOK_SOURCE_DIR;

constexpr const char* kJournal = R"({"relook": "journal/1", "steps": [
  {"edit": [{"op": "replace", "path": "/lights/Lamp/intensity", "value": 40}]},
  {"edit": [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.1, 1, 0]}]}]})";

/// A command; "@in/" is the folder with what is there already, "@out/" the one for what it writes.
struct VerbCase {
  std::string name;
  std::vector<std::string> command;
};

const std::vector<VerbCase> kVerbs{
    {"render", {"render", "@in/scene.gltf", "-o", "@out/x.exr", "--resolution", "64x36", "--samples", "4", "--aovs"}},
    {"preprocess", {"preprocess", "@in/scene.gltf", "-o", "@out/c", "--resolution", "64x36", "--samples", "4"}},
    {"replay", {"replay", "@in/c", "@in/j.json", "-o", "@out/run", "--verify", "--overlays", "--trace", "@out/t.json"}},
    {"replay_of_two", {"replay", "@in/c", "@in/j.json", "@in/k.json", "-o", "@out/run", "--access-log", "@out/log"}},
    {"compare", {"compare", "@in/run", "@in/run", "-o", "@out/compare"}},
    {"inspect", {"inspect", "@in/j.json", "--scene", "@in/c", "--trace", "@out/t.json"}},
    {"check", {"check", "@in/c", "--trace", "@out/t.json"}},
    {"tune", {"tune", "@in/log", "--trace", "@out/t.json"}},
    {"blame", {"blame", "@in/run", "30,20", "--trace", "@out/t.json"}},
    {"plan", {"plan", "@in/c", "@in/j.json", "--json=@out/plan.json", "--trace", "@out/t.json"}},
    {"diff", {"journal", "diff", "@in/scene.gltf", "@in/other.gltf", "-o", "@out/d.json"}},
    {"wedge", {"journal", "wedge", "@in/scene.gltf", "/lights/Lamp/intensity", "5", "10", "-o", "@out/w.json"}},
    {"completions", {"completions", "bash"}}};

std::string text_in(const std::filesystem::path& path) { return std::string(text_of(read_file(path))); }

/// The structure and the words of a JSON value: no times, no counts of bytes.
Json without_numbers(const Json& value) {
  if (value.is_number()) return 0;
  if (!value.is_structured()) return value;
  Json result = value.is_array() ? Json::array() : Json::object();
  for (const auto& [key, item] : value.items()) {
    if (value.is_array())
      result.push_back(without_numbers(item));
    else if (key != "command" && key != "seal")  // numbers, too, in letters
      result[key] = without_numbers(item);
  }
  return result;
}

/// What a file says apart from when and where: its bytes, or those of its JSON values, or the words of an access log.
std::string content(const std::filesystem::path& path, const std::string& folder) {
  std::string text = text_in(path);
  const std::string suffix = path.extension().string();
  if (suffix == ".html") {  // has times all over
    const bool is_whole = text.starts_with("<!DOCTYPE html>") && text.find("</html>") >= text.size() - 9;
    return is_whole ? "a page" : "no page";
  }
  for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
    text.replace(at, folder.size(), "OUT");
  if (suffix == ".json") return without_numbers(parse_json(text, path.string())).dump();
  if (suffix.empty()) std::erase_if(text, [](char c) { return c != '\n' && (c < 'a' || c == 'e' || c > 'z'); });
  if (suffix != ".jsonl") return text;
  std::string lines;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
    end = std::min(text.find('\n', begin), text.size());
    lines += without_numbers(parse_json(text.substr(begin, end - begin), path.string())).dump() + "\n";
  }
  return lines;
}

std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder).string()] = content(entry.path(), folder.string());
  return files;
}

class Descriptors : public testing::TestWithParam<VerbCase> {
 protected:
  void SetUp() override {
    std::filesystem::copy(kSource / "scenes/spheres", folder_ / "in", std::filesystem::copy_options::recursive);
    std::filesystem::rename(folder_ / "in/spheres.gltf", folder_ / "in/scene.gltf");
    Json other = parse_json(text_in(folder_ / "in/scene.gltf"), "scene.gltf");
    other["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.2, 0.3, 1};
    write_file(folder_ / "in/other.gltf", other.dump());
    for (const char* journal : {"in/j.json", "in/k.json"}) write_file(folder_ / journal, std::string_view(kJournal));
    run("in", {"preprocess", "@in/scene.gltf", "-o", "@in/c", "--resolution", "64x36", "--samples", "4", "--quiet"},
        "");
    run("in", {"replay", "@in/c", "@in/j.json", "-o", "@in/run", "--access-log", "@in/log", "--quiet"}, "");
  }

  /// Through a shell that closes descriptors by `redirections`.
  void run(const std::string& out, std::vector<std::string> command, const std::string& redirections) {
    std::filesystem::create_directories(folder_ / out);
    for (std::string& word : command)
      for (const auto& [mark, name] : {std::pair{std::string("@in/"), std::string("in")}, {"@out/", out}})
        if (const std::size_t at = word.find(mark); at != std::string::npos)
          word.replace(at, mark.size(), (folder_ / name).string() + "/");
    command.insert(command.begin(), {"sh", "-c", "exec \"$@\" " + redirections, "sh", RELOOK_PROGRAM});
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, 0) << redirections << ": " << result.output;
  }

  ScratchFolder folder_{"descriptors"};
};

TEST_P(Descriptors, that_are_closed_put_nothing_into_files) {
  run("whole", GetParam().command, "");
  const std::map<std::string, std::string> whole = contents(folder_ / "whole");
  EXPECT_EQ(whole.empty(), GetParam().name == "completions");
  for (unsigned closed = 1; closed < 8; ++closed) {
    std::string redirections;
    if ((closed & 1U) != 0) redirections += "<&- ";
    if ((closed & 2U) != 0) redirections += ">&- ";
    if ((closed & 4U) != 0) redirections += "2>&- ";
    const std::string out = "out" + std::to_string(closed);
    run(out, GetParam().command, redirections);
    for (const auto& [name, text] : contents(folder_ / out))
      EXPECT_TRUE(whole.contains(name) && whole.at(name) == text) << redirections << name;
    EXPECT_EQ(contents(folder_ / out).size(), whole.size()) << redirections;
  }
}

// The notes of a run are open from its start to its end, but gone when it is complete: a run that is killed shows them.
TEST(ClosedDescriptors, put_nothing_into_the_notes_of_a_run) {
  const ScratchFolder folder("notes");
  std::string journal = R"({"relook": "journal/1", "steps": [)";
  for (int i = 0; i < 300; ++i)
    journal += std::string(i == 0 ? "" : ",") +
               R"({"edit": [{"op": "replace", "path": "/lights/Lamp/intensity", "value": )" + std::to_string(40 + i) +
               "}]}";
  write_file(folder / "j.json", journal + "]}");
  const std::string scene = (kSource / "scenes/spheres/spheres.gltf").string();
  const std::string script = R"(cd "$1" && "$2" preprocess "$3" -o c --resolution 64x36 --quiet || exit 1
    "$2" replay c j.json -o run --verify 2>&- >/dev/null &
    until [ -e run/frames/0003.exr ] || ! kill -0 $!; do sleep 0.01; done
    kill -9 $! && test -s run/progress.jsonl)";
  const ProgramResult result = run_program({"sh", "-c", script, "sh", (folder / "").string(), RELOOK_PROGRAM, scene});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const std::string notes = text_in(folder / "run/progress.jsonl");
  for (std::size_t begin = 0, end = 0; (end = notes.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string note = notes.substr(begin, end - begin);
    EXPECT_TRUE(Json::accept(note.substr(std::min(note.find('{'), note.size())))) << note;  // after a hash
    EXPECT_EQ(note.find(" %"), std::string::npos) << note;
  }
}

INSTANTIATE_TEST_SUITE_P(Verbs, Descriptors, testing::ValuesIn(kVerbs),
                         [](const auto& verb) { return verb.param.name; });

}  // namespace
}  // namespace relook
