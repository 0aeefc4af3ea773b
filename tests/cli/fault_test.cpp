// Faults to survive: afterwards there is either the right frame, or one line that says what is wrong; never a half file
// under a final name.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "base/json.h"
#include "frame/frame_file.h"
#include "run_program.h"

namespace relook {
namespace {

using namespace std::chrono_literals;

std::string long_journal(int steps) {
  std::string text = R"({"relook": "journal/1", "steps": [)";
  for (int i = 0; i < steps; ++i)
    text += (i > 0 ? "," : std::string()) +
            R"({"name": "step", "edit": [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0, )" +
            std::to_string(1 + i * 0.001) + ", 0]}]}";
  return text + "]}";
}

std::vector<std::string> files_below(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error))
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Every frame under a final name is whole.
void expect_whole_frames(const std::filesystem::path& run) {
  for (const std::string& name : files_below(run / "frames")) {
    EXPECT_TRUE(name.ends_with(".exr")) << name << " remains";
    if (!name.ends_with(".exr")) continue;
    EXPECT_NO_THROW(static_cast<void>(decode_exr(run / "frames" / name))) << name;
  }
}

class Fault : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void make_cache(const std::string& resolution) const {
    const ProgramResult made =
        relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", resolution, "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.output;
  }
  void write_journal(int steps) const { std::ofstream(at("j.json")) << long_journal(steps); }
  ScratchFolder folder_{"fault"};
};

TEST_F(Fault, sigterm_leaves_finished_frames_a_report_and_no_temporary_files) {
  make_cache("320x180");
  write_journal(2000);
  const pid_t child = start_relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"});
  for (int i = 0; i < 1000 && !std::filesystem::exists(at("run/frames/0003.exr")); ++i)
    std::this_thread::sleep_for(10ms);
  ASSERT_TRUE(std::filesystem::exists(at("run/frames/0003.exr")));
  kill(child, SIGTERM);
  const std::size_t frames = files_below(at("run/frames")).size();
  EXPECT_EQ(wait_for(child), 128 + SIGTERM);
  EXPECT_LE(files_below(at("run/frames")).size(), frames + 2) << "no more than what it is at";
  expect_whole_frames(at("run"));
  const Bytes bytes = read_file(at("run/report.json"));
  const Json report = parse_json(text_of(bytes), "report.json");
  EXPECT_EQ(report["interrupted"], true);
  EXPECT_EQ(report["steps"].size(), files_below(at("run/frames")).size());
}

TEST_F(Fault, a_run_short_of_memory_is_taken_up_with_more) {
  make_cache("160x90");
  write_journal(3);
  const ProgramResult refused = relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--memory", "1M"});
  EXPECT_EQ(refused.exit_code, 4) << refused.output;
  EXPECT_NE(refused.output.find("needs at least"), std::string::npos) << refused.output;
  const auto report = [&] { return parse_json(text_of(read_file(at("run/report.json"))), "report.json"); };
  EXPECT_EQ(report()["interrupted"], true);
  EXPECT_EQ(report()["steps"].size(), 1U);
  const ProgramResult taken_up = relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--memory", "4G"});
  EXPECT_EQ(taken_up.exit_code, 0) << taken_up.output;
  EXPECT_EQ(report()["interrupted"], false);
  EXPECT_EQ(report()["resumed"]["frames"], 1);
  EXPECT_EQ(report()["steps"].size(), 4U);
  expect_whole_frames(at("run"));
}

TEST_F(Fault, sigterm_during_preprocess_leaves_nothing) {
  const pid_t child = start_relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("big"), "--resolution",
                                    "1920x1080", "--samples", "16", "--quiet"});
  std::this_thread::sleep_for(300ms);
  kill(child, SIGTERM);
  EXPECT_EQ(wait_for(child), 128 + SIGTERM);
  EXPECT_EQ(files_below(at("")), std::vector<std::string>{});
}

TEST_F(Fault, kill_during_preprocess_leaves_a_sound_cache_or_none) {
  make_cache("64x36");
  for (int i = 0; i < 12; ++i) {
    const pid_t child = start_relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution",
                                      "320x180", "--quiet", "--overwrite"});
    std::this_thread::sleep_for(std::chrono::milliseconds(30 + 40 * i));
    kill(child, SIGKILL);
    wait_for(child);
    const ProgramResult checked = relook({"check", at("c")});
    EXPECT_EQ(checked.exit_code, 0) << checked.output;
  }
}

TEST_F(Fault, kill_during_replay_leaves_whole_frames_only) {
  make_cache("160x90");
  write_journal(2000);
  for (int i = 0; i < 4; ++i) {
    const pid_t child = start_relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"});
    std::this_thread::sleep_for(std::chrono::milliseconds(150 + 70 * i));
    kill(child, SIGKILL);
    wait_for(child);
    for (const std::string& name : files_below(at("run/frames"))) {
      if (!name.ends_with(".exr")) continue;
      EXPECT_NO_THROW(static_cast<void>(decode_exr(at("run/frames/" + name)))) << name;
    }
    EXPECT_FALSE(std::filesystem::exists(at("run/report.json")));
  }
  write_journal(2);
  EXPECT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 1) << "has further steps";
  EXPECT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(files_below(at("run/frames")).size(), 3U) << "frames of the killed run are gone";
}

TEST_F(Fault, two_replays_of_one_cache_agree_and_leave_it_untouched) {
  make_cache("160x90");
  write_journal(5);
  const std::vector<std::string> before = files_below(at("c"));
  const pid_t first = start_relook({"replay", at("c"), at("j.json"), "-o", at("one"), "--quiet"});
  const pid_t second = start_relook({"replay", at("c"), at("j.json"), "-o", at("two"), "--quiet"});
  EXPECT_EQ(wait_for(first), 0);
  EXPECT_EQ(wait_for(second), 0);
  EXPECT_EQ(relook({"compare", at("one"), at("two"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(files_below(at("c")), before);
  EXPECT_EQ(relook({"check", at("c"), "--quiet"}).exit_code, 0);
}

TEST_F(Fault, two_preprocesses_to_one_output_leave_one_sound_cache) {
  // The later one finds that it has done the same, or is refused, or asked to replace what the other has written.
  const auto codes_of = [&](const std::string& second_resolution, const std::vector<std::string>& flags) {
    std::vector<std::string> one{"preprocess", kScene,    "--integrator", "whitted", "-o",
                                 at("c"),      "--quiet", "--resolution", "160x90"},
        other = one;
    other.back() = second_resolution;
    one.insert(one.end(), flags.begin(), flags.end());
    other.insert(other.end(), flags.begin(), flags.end());
    const pid_t first = start_relook(one), second = start_relook(other);
    const std::multiset<int> codes{wait_for(first), wait_for(second)};
    EXPECT_EQ(relook({"check", at("c"), "--quiet"}).exit_code, 0);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(at("")), {}), 1) << "temporary folders remain";
    std::filesystem::remove_all(at("c"));
    return codes;
  };
  EXPECT_EQ(codes_of("160x90", {}), (std::multiset<int>{0, 0}));
  EXPECT_EQ(codes_of("161x91", {}), (std::multiset<int>{0, 1}));
  EXPECT_EQ(codes_of("161x91", {"--overwrite"}), (std::multiset<int>{0, 0}));
}

/// Runs the program in an address space of so many kilobytes.
ProgramResult relook_within(const std::string& kilobytes, const std::string& arguments) {
  return run_program({"sh", "-c", "ulimit -v " + kilobytes + "; exec \"" + RELOOK_PROGRAM + "\" " + arguments});
}

TEST_F(Fault, a_memory_limit_gives_a_frame_or_one_line) {
  int limits_tried = 0;
  for (const char* kilobytes : {"550000", "600000", "650000", "700000", "800000", "1000000"}) {
    if (relook_within(kilobytes, "--version").exit_code != 0) continue;  // its libraries alone do not fit
    ++limits_tried;
    const ProgramResult result = relook_within(
        kilobytes, "render \"" + kScene + "\" -o \"" + at("m.exr") + "\" --resolution 320x180 --samples 4 --quiet");
    if (result.exit_code == 0) {
      EXPECT_NO_THROW(static_cast<void>(decode_exr(at("m.exr"))));
      std::filesystem::remove(at("m.exr"));
    } else {
      EXPECT_EQ(result.exit_code, 4) << kilobytes << " KB: " << result.output;
      EXPECT_EQ(files_below(at("")), std::vector<std::string>{});
    }
  }
  if (limits_tried == 0) GTEST_SKIP() << "SKIPPED: the program does not start within any of these limits";
}

/// A file system of its own, so small that it fills up.
class SmallDisk {
 public:
  SmallDisk(const std::string& path, const std::string& size) : path_(path) {
    std::filesystem::create_directories(path);
    is_mounted_ = mount("tmpfs", path.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
  }
  ~SmallDisk() {
    if (is_mounted_) umount2(path_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  [[nodiscard]] bool is_mounted() const { return is_mounted_; }

 private:
  std::string path_;
  bool is_mounted_ = false;
};

TEST_F(Fault, a_full_disk_during_preprocess_leaves_nothing) {
  const SmallDisk disk(at("disk"), "128k");
  if (!disk.is_mounted()) GTEST_SKIP() << "SKIPPED: mounting a small tmpfs is not permitted here";
  const ProgramResult result = relook(
      {"preprocess", kScene, "--integrator", "whitted", "-o", at("disk/c"), "--resolution", "160x90", "--quiet"});
  EXPECT_EQ(result.exit_code, 4) << result.output;
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  EXPECT_EQ(files_below(at("disk")), std::vector<std::string>{});
  EXPECT_FALSE(std::filesystem::exists(at("disk/c")));
}

TEST_F(Fault, a_full_disk_during_preprocess_is_told_by_the_output_of_the_user) {
  const SmallDisk disk(at("disk"), "128k");
  if (!disk.is_mounted()) GTEST_SKIP() << "SKIPPED: mounting a small tmpfs is not permitted here";
  const ProgramResult result = relook(
      {"preprocess", kScene, "--integrator", "whitted", "-o", at("disk/c"), "--resolution", "160x90", "--quiet"});
  EXPECT_EQ(result.exit_code, 4) << result.output;
  EXPECT_TRUE(result.output.starts_with("relook: " + at("disk/c"))) << result.output;
  EXPECT_EQ(result.output.find(".relook-"), std::string::npos) << result.output;
}

TEST_F(Fault, a_look_document_that_does_not_fit_on_standard_output_exits_6) {
  for (const std::string& command : {"inspect \"" + kScene + "\" --look", std::string("replay --help")}) {
    const ProgramResult result =
        run_program({"sh", "-c", std::string("exec \"") + RELOOK_PROGRAM + "\" " + command + " >/dev/full"});
    EXPECT_EQ(result.exit_code, 6) << command << ": " << result.output;
    EXPECT_EQ(result.output, "relook: standard output: cannot be written\n") << command;
  }
}

TEST_F(Fault, a_full_disk_during_replay_leaves_no_half_file) {
  make_cache("160x90");
  write_journal(200);
  const SmallDisk disk(at("disk"), "512k");
  if (!disk.is_mounted()) GTEST_SKIP() << "SKIPPED: mounting a small tmpfs is not permitted here";
  const ProgramResult result = relook({"replay", at("c"), at("j.json"), "-o", at("disk/run"), "--quiet"});
  EXPECT_EQ(result.exit_code, 4) << result.output;
  expect_whole_frames(at("disk/run"));
  EXPECT_FALSE(files_below(at("disk/run/frames")).empty());
  EXPECT_FALSE(std::filesystem::exists(at("disk/run/report.json")));
}

TEST_F(Fault, a_full_disk_during_render_leaves_no_frame) {
  const SmallDisk disk(at("disk"), "16k");
  if (!disk.is_mounted()) GTEST_SKIP() << "SKIPPED: mounting a small tmpfs is not permitted here";
  const ProgramResult result = relook(
      {"render", kScene, "--integrator", "whitted", "-o", at("disk/x.exr"), "--resolution", "160x90", "--quiet"});
  EXPECT_EQ(result.exit_code, 4) << result.output;
  EXPECT_EQ(files_below(at("disk")), std::vector<std::string>{});
}

TEST_F(Fault, a_read_only_cache_is_enough_for_a_replay) {
  make_cache("64x36");
  write_journal(2);
  const SmallDisk disk(at("disk"), "16m");
  if (!disk.is_mounted()) GTEST_SKIP() << "SKIPPED: mounting a small tmpfs is not permitted here";
  std::filesystem::copy(at("c"), at("disk/c"), std::filesystem::copy_options::recursive);
  ASSERT_EQ(mount("tmpfs", at("disk").c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr), 0);
  EXPECT_EQ(relook({"replay", at("disk/c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(
      relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("disk/c"), "--resolution", "64x36", "--quiet"})
          .exit_code,
      0)
      << "it is complete";
  EXPECT_EQ(relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("disk/c"), "--resolution", "64x36",
                    "--quiet", "--overwrite"})
                .exit_code,
            6);
}

}  // namespace
}  // namespace relook
