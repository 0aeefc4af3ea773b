// What an installation brings to shells and readers: completions driven in bash, zsh and fish, the manual page,
// versions as JSON.
#include <algorithm>
#include <set>

#include "cli_fixture.h"

namespace relook {
namespace {

class Shell : public Cli {
 protected:
  /// What bash offers at the end of a line, in its order, after each word a space. The last of `words` is unfinished.
  [[nodiscard]] std::string complete(const std::string& words) const {
    write_text(at("complete.bash"), relook({"completions", "bash"}).output);
    const std::string run = "source " + at("complete.bash") + "; COMP_WORDS=(" + std::string(RELOOK_PROGRAM) + " " +
                            words + "); COMP_CWORD=$((${#COMP_WORDS[@]}-1)); _relook \"${COMP_WORDS[0]}\"; " +
                            "printf '%s ' \"${COMPREPLY[@]}\"";
    return run_program({"bash", "-c", run}).output;
  }
  void write_journal() const { write_text(at("j.json"), kJournal); }
};

TEST_F(Shell, completes_verbs_options_and_values) {
  EXPECT_EQ(complete("prep"), "preprocess ");
  EXPECT_EQ(complete("journal va"), "variants ");
  EXPECT_EQ(complete("replay --policy l"), "lru ");
  EXPECT_EQ(complete("replay --policy = l"), "lru ");
  EXPECT_EQ(complete("replay --prog"), "--progress ");
  EXPECT_EQ(complete("journal animation --fp"), "--fps ");
  EXPECT_EQ(complete("compare --progress o"), "openjd ");
  EXPECT_EQ(complete("completions f"), "fish ");
  EXPECT_EQ(complete("no such verb --x").find("--x"), std::string::npos);
}

TEST_F(Shell, completes_files_where_nothing_else_is_meant) {
  write_journal();
  EXPECT_EQ(complete("check " + at("j.js")), at("j.json") + " ");
  EXPECT_EQ(complete("render " + kScene + " --look " + at("j.js")), at("j.json") + " ");
}

TEST_F(Shell, completes_what_scenes_and_journals_name) {
  write_journal();
  ASSERT_EQ(preprocess("c").exit_code, 0);
  EXPECT_EQ(complete("render " + kScene + " --camera M"), "Main ");
  EXPECT_EQ(complete("render --camera = M " + kScene).find("Main"), std::string::npos);  // it is the scene's place
  EXPECT_EQ(complete("render " + kScene + " --camera = M"), "Main ");
  EXPECT_EQ(complete("journal wedge " + kScene + " /li"), "/lights/ ");
  EXPECT_EQ(complete("journal wedge " + kScene + " /lights/"), "/lights/Lamp/ ");
  EXPECT_EQ(complete("journal wedge " + kScene + " /lights/Lamp/in"), "/lights/Lamp/intensity ");
  EXPECT_EQ(complete("replay " + at("c") + " " + at("j.json") + " --params /materials/Pa"), "/materials/Paint/ ");
  EXPECT_EQ(complete("replay " + at("c") + " " + at("j.json") + " --steps ''"), "0 1 2 ");
  EXPECT_EQ(complete("render " + kScene + " --journal " + at("j.json") + " --step 2"), "2 ");
  EXPECT_EQ(complete("render " + at("none.glb") + " --camera M"), " ");
}

/// A name is never run, and comes out quoted.
TEST_F(Shell, quotes_names) {
  write_text(at("c"), "");
  std::filesystem::remove(at("c"));
  std::filesystem::create_directory(at("c"));
  const Json names{{"Key one", {{"a", 1}}}, {"$(touch ran)", {{"a", 1}}}, {"x\u0007", {{"a", 1}}}};
  write_text(at("c/look.json"), Json{{"lights", names}}.dump());
  EXPECT_EQ(complete("replay " + at("c") + " j.json --params /lights/Key"), "/lights/Key\\ one/ ");
  EXPECT_EQ(complete("replay " + at("c") + " j.json --params /lights/Key\\ one/"), "/lights/Key\\ one/a ");
  EXPECT_EQ(complete("replay " + at("c") + " j.json --params /lights/"),
            "/lights/\\$\\(touch\\ ran\\)/ /lights/Key\\ one/ ");
  EXPECT_FALSE(std::filesystem::exists("ran"));
}

TEST_F(Shell, scripts_are_sound_in_each_shell) {
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    write_text(at(shell), relook({"completions", shell}).output);
    EXPECT_NE(relook({"completions", shell}).output.find(" complete "), std::string::npos);
    if (run_program({shell, "-c", "exit 0"}).exit_code != 0) continue;
    EXPECT_EQ(run_program({shell, "-n", at(shell)}).output, "") << shell;
  }
  EXPECT_EQ(relook({"completions", "tcsh"}).exit_code, 1);
  if (run_program({"fish", "-c", "exit 0"}).exit_code != 0) return;
  const std::string line = std::string(RELOOK_PROGRAM) + " journal wedge " + kScene + " /lights/Lamp/in";
  const ProgramResult fish = run_program({"fish", "-c", "source " + at("fish") + "; complete -C '" + line + "'"});
  EXPECT_EQ(fish.output, "/lights/Lamp/intensity\n");
}

TEST_F(Shell, manual_has_every_verb_and_option) {
  const std::string page = relook({"--help-man"}).output;
  write_text(at("relook.1"), page);
  for (const char* part : {".SS relook replay", ".SS relook journal diff", "\\fB\\-\\-tunnels\\fR", ".SH EXIT STATUS",
                           "128 + N", "relook blame runs/night 960,540", "weight|plain\\-weight|lru|size|gdsf"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  for (const char* const verb : {"replay", "render", "preprocess", "compare"}) {
    const std::string help = relook({verb, "--help"}).output;
    for (std::size_t i = help.find("  --"); i != std::string::npos; i = help.find("  --", i + 1)) {
      std::string option;
      for (const char letter : help.substr(i + 2, help.find_first_of(" ,={\n", i + 2) - i - 2))
        option += letter == '-' ? "\\-" : std::string(1, letter);
      EXPECT_NE(page.find(option), std::string::npos) << option;
    }
  }
  if (run_program({"groff", "--version"}).exit_code != 0) GTEST_SKIP() << "no groff: the manual page is NOT typeset";
  const ProgramResult set = run_program({"groff", "-man", "-Tutf8", "-ww", "-z", at("relook.1")});
  EXPECT_EQ(set.output, "");
}

TEST_F(Shell, versions_are_an_object) {
  const Json version = parse_json(relook({"--version", "--json"}).output, "");
  EXPECT_EQ(version["relook"], "version/1");
  const std::string text = relook({"--version"}).output;
  EXPECT_NE(text.find("relook " + version["program"].get<std::string>() + "\n"), std::string::npos);
  EXPECT_NE(text.find("Embree " + version["libraries"]["Embree"].get<std::string>()), std::string::npos);
  EXPECT_NE(text.find(version["arithmetic"]["instructions"].get<std::string>()), std::string::npos);
  EXPECT_NE(text.find("sandbox: " + version["sandbox"].get<std::string>()), std::string::npos);
  EXPECT_TRUE(version["libraries"].contains("OpenEXR"));
  EXPECT_EQ(version["features"]["images"], true);
  EXPECT_TRUE(version["verbs"].contains("replay"));
  EXPECT_EQ(version["verbs"]["journal"][0], "diff");
  for (const char* schema : {"journal/1", "report/1", "cache/6"})
    EXPECT_TRUE(std::ranges::count(version["schemas"], Json(schema)) == 1) << schema;
  EXPECT_EQ(relook({"--json", "--version"}).output, relook({"--version", "--json"}).output);
}

}  // namespace
}  // namespace relook
