// What is written in Python: cli/python/relook.py and the recipes of scenes/recipes, tried with the program; types by
// mypy where it is installed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kPython = std::filesystem::path(RELOOK_SOURCE_DIR) / "tests/python";

/// Runs a script of tests/python, which finds the program in $RELOOK. Exit code 77: it cannot be tried here, and says
/// why.
void run_script(const std::string& name, const std::vector<std::string>& cases = {}) {
  std::vector<std::string> command{"env", "RELOOK=" + std::string(RELOOK_PROGRAM), "PYTHONDONTWRITEBYTECODE=1",
                                   "python3", (kPython / name).string()};
  command.insert(command.end(), cases.begin(), cases.end());
  const ProgramResult result = run_program(command);
  if (result.exit_code == 77) GTEST_SKIP() << result.output;
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST(Python, relook_py_runs_the_program) { run_script("relook_test.py"); }

TEST(Python, relook_py_has_types) {
  if (run_program({"mypy", "--version"}).exit_code != 0) GTEST_SKIP() << "mypy is not installed";
  const std::string file = (std::filesystem::path(RELOOK_SOURCE_DIR) / "cli/python/relook.py").string();
  const ProgramResult result =
      run_program({"mypy", "--strict", "--python-version", "3.9", "--cache-dir=/dev/null", file});
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST(Recipes, a_farms_chunks_add_up) { run_script("recipes_test.py", {"Farm"}); }

TEST(Recipes, layers_are_those_of_the_frame) { run_script("recipes_test.py", {"Layers"}); }

TEST(Recipes, two_saves_of_blender_become_a_journal) { run_script("recipes_test.py", {"Blender"}); }

}  // namespace
}  // namespace relook
