// Every call of preprocess and replay that changes a file system, failing or ending the program: afterwards nothing
// wrong is to be seen under a final name, and doing it again gives the very bytes of an undisturbed run. Some points by
// default; all of them, a longer journal and every byte of a cache with RELOOK_FAULTS=all in the environment.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "base/files.h"
#include "base/json.h"
#include "run_program.h"

namespace relook {
namespace {

constexpr const char* kModes[] = {"kill", "after", "eio", "enospc", "short"};

bool does_all() {
  const char* const wanted = std::getenv("RELOOK_FAULTS");
  return wanted != nullptr && std::string(wanted) == "all";
}

/// The bytes of all files below a folder whose names do not begin with one of `without`, by name.
std::map<std::string, Bytes> contents(const std::filesystem::path& folder, const std::set<std::string>& without = {}) {
  std::map<std::string, Bytes> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_regular_file() && !without.contains(name)) files[name] = frame_bytes(entry.path());
  }
  return files;
}

std::string journal_text(int steps) {
  Json list = Json::array();
  for (int i = 0; i < steps; ++i) {
    const auto place = [&](double x) {
      return Json::array(
          {{{"op", "replace"}, {"path", "/nodes/CentralSphere/translation"}, {"value", {x, 1 + 0.05 * i, 0}}}});
    };
    Json step{{"name", "step " + std::to_string(i)}};
    if (i == 2) {
      step["select"] = {"/nodes/CentralSphere"};
      step["drag"] = {place(0.1), place(0.2)};
    } else {
      step["edit"] = place(0);
    }
    list.push_back(std::move(step));
  }
  return Json{{"relook", "journal/1"}, {"steps", std::move(list)}}.dump();
}

class KillPoints : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  /// Runs relook with the shim. `fault`: "n:MODE", or "" to count the calls.
  [[nodiscard]] ProgramResult run(const std::vector<std::string>& arguments,
                                  const std::string& fault = "0:none") const {
    std::vector<std::string> command{"env", std::string("LD_PRELOAD=") + RELOOK_FAULT_SHIM, "RELOOK_FAULT=" + fault,
                                     "RELOOK_FAULT_COUNT=" + at("count"), RELOOK_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    command.push_back("--quiet");
    return run_program(command);
  }
  [[nodiscard]] long calls_of(const std::vector<std::string>& arguments) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    long calls = 0;
    std::ifstream(at("count")) >> calls;
    return calls;
  }
  [[nodiscard]] std::vector<std::string> preprocess(const std::string& cache) const {
    return {"preprocess", kScene, "--integrator", "whitted", "-o", at(cache), "--resolution", "40x24"};
  }
  [[nodiscard]] std::vector<std::string> replay(const std::string& into) const {
    return {"replay", at("reference"), at("j.json"), "-o", at(into)};
  }
  void make_reference() const {
    ASSERT_EQ(run(preprocess("reference")).exit_code, 0);
    std::ofstream(at("j.json")) << journal_text(does_all() ? 24 : 4);
  }

  /// Calls visit("n:MODE") for the points to try of an action of `calls` calls.
  template <class Visit>
  void for_each_point(long calls, const Visit& visit, long by_default = 8) {
    ASSERT_GT(calls, 10);
    const long stride = does_all() ? 1 : std::max(1L, calls / by_default);
    for (const char* mode : kModes)
      for (long n = 1; n <= calls; n += stride) {
        const std::string fault = std::to_string(n) + ":" + mode;
        SCOPED_TRACE(fault);
        visit(fault);
        ++points_;
      }
    RecordProperty("points", static_cast<int>(points_));
    std::printf("%ld points of %ld calls\n", points_, calls);
  }
  static void expect_sensible(const ProgramResult& result) {
    const bool is_sensible =
        result.exit_code == 0 || result.exit_code == 4 || result.exit_code == 6 || result.exit_code == 128 + SIGKILL;
    EXPECT_TRUE(is_sensible) << result.exit_code << ": " << result.output;
    if (result.exit_code == 4 || result.exit_code == 6) {
      EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
    }
  }
  /// Files under final names are those of `whole`, all of them when the program says so.
  void expect_right_frames(const ProgramResult& result, const std::map<std::string, Bytes>& whole,
                           const std::string& run_folder) const {
    for (const char* part : {"frames", "previews"})
      for (const auto& [name, bytes] : contents(at(run_folder + "/" + part))) {
        const bool was_killed = result.exit_code == 128 + SIGKILL ||
                                std::filesystem::exists(std::filesystem::path(at("half")) / part / name);
        if (name.starts_with(".") && was_killed) continue;
        const auto found = whole.find(std::string(part) + "/" + name);
        ASSERT_TRUE(found != whole.end()) << part << "/" << name;
        EXPECT_TRUE(found->second == bytes) << part << "/" << name;
      }
  }
  /// Replays into a folder that `prepare` makes, with each fault, and then without.
  template <class Prepare>
  void check_replays(long calls, const std::map<std::string, Bytes>& whole, const Prepare& prepare) {
    for_each_point(calls, [&](const std::string& fault) {
      prepare();
      const ProgramResult result = run(replay("run"), fault);
      expect_sensible(result);
      expect_right_frames(result, whole, "run");
      const ProgramResult again = run(replay("run"));
      EXPECT_EQ(again.exit_code, 0) << again.output;
      const std::map<std::string, Bytes> files = contents(at("run"), {"report.json", "report.html"});
      for (const auto& file : files) EXPECT_TRUE(whole.contains(file.first)) << file.first << " remains";
      EXPECT_TRUE(files == whole);
      const Json report = parse_json(text_of(read_file(at("run/report.json"))), "report.json");
      EXPECT_EQ(report["frames"].size(), contents(at("run/frames")).size());
      EXPECT_EQ(report["steps"].size(), report["frames"].size() + 1) << "a drag has its own entry, too";
    });
  }

  ScratchFolder folder_{"kill"};
  long points_ = 0;
};

TEST_F(KillPoints, preprocess) {
  make_reference();
  const std::map<std::string, Bytes> whole = contents(at("reference"));
  const std::filesystem::path place = folder_ / "place";
  std::filesystem::create_directory(place);
  for (const bool replaces : {false, true}) {
    if (!replaces) std::filesystem::remove_all(place / "c");
    std::vector<std::string> command = preprocess("place/c");
    if (replaces) command.push_back("--overwrite");
    const long calls = calls_of(command);
    for_each_point(
        calls,
        [&](const std::string& fault) {
          if (!replaces) std::filesystem::remove_all(place / "c");
          const ProgramResult result = run(command, fault);
          expect_sensible(result);
          if (std::filesystem::exists(place / "c")) {
            EXPECT_TRUE(contents(place / "c") == whole);
          } else {
            EXPECT_FALSE(replaces);
          }
          EXPECT_EQ(run(preprocess("place/c")).exit_code, 0);
          EXPECT_TRUE(contents(place / "c") == whole);
          EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place), {}), 1) << "temporary folders remain";
        },
        2);
  }
}

TEST_F(KillPoints, replay) {
  make_reference();
  const long calls = calls_of(replay("whole"));
  const std::map<std::string, Bytes> whole = contents(at("whole"), {"report.json", "report.html"});
  check_replays(calls, whole, [&] { std::filesystem::remove_all(at("run")); });
}

TEST_F(KillPoints, resume) {
  make_reference();
  const long calls = calls_of(replay("whole"));
  const std::map<std::string, Bytes> whole = contents(at("whole"), {"report.json", "report.html"});
  ASSERT_EQ(run(replay("half"), std::to_string(calls / 2) + ":kill").exit_code, 128 + SIGKILL);
  const auto prepare = [&] {
    std::filesystem::remove_all(at("run"));
    std::filesystem::copy(at("half"), at("run"), std::filesystem::copy_options::recursive);
  };
  prepare();
  const long calls_left = calls_of(replay("run"));
  EXPECT_LT(calls_left, calls * 3 / 4);
  const Json report = parse_json(text_of(read_file(at("run/report.json"))), "report.json");
  EXPECT_GT(report["resumed"]["frames"], 0);
  EXPECT_EQ(report["steps"][0]["resumed"], true);
  EXPECT_EQ(report["steps"].back()["resumed"], false);
  check_replays(calls_left, whole, prepare);
}

TEST_F(KillPoints, a_run_killed_fifty_times_ends_with_the_bytes_of_an_undisturbed_one) {
  make_reference();
  std::ofstream(at("j.json")) << journal_text(40);
  ASSERT_EQ(run(replay("whole")).exit_code, 0);
  const std::map<std::string, Bytes> whole = contents(at("whole"), {"report.json", "report.html"});
  int killed = 0;
  for (int i = 0; i < 50; ++i) {
    const ProgramResult result = run(replay("run"), std::to_string(12 + i * 7 % 23) + ":kill");
    ASSERT_TRUE(result.exit_code == 128 + SIGKILL || result.exit_code == 0) << result.exit_code << result.output;
    killed += result.exit_code == 0 ? 0 : 1;
    for (const auto& [name, bytes] : contents(at("run/frames"))) {
      if (name.starts_with(".")) continue;
      ASSERT_TRUE(whole.contains("frames/" + name)) << name;
      EXPECT_TRUE(whole.at("frames/" + name) == bytes) << name;
    }
  }
  EXPECT_GT(killed, 20);
  const ProgramResult last = run(replay("run"));
  EXPECT_EQ(last.exit_code, 0) << last.output;
  EXPECT_TRUE(contents(at("run"), {"report.json", "report.html"}) == whole);
}

}  // namespace
}  // namespace relook
