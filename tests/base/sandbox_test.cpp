// The sandbox: what it refuses, tried call by call, and what goes on working in it, whatever way files are named.
#include "base/system/sandbox.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <sstream>

#include "base/files.h"
#include "run_program.h"
#include "shim/hostile_calls.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = fs::path(RELOOK_SOURCE_DIR) / "scenes";

/// What `work` says in a process of its own that has entered the sandbox.
std::string said_within(const Reach& reach, const std::function<std::string()>& work) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    enter_sandbox(reach);
    const std::string said = work();
    _exit(write(pipe_ends[1], said.data(), said.size()) == static_cast<ssize_t>(said.size()) ? 0 : 1);
  }
  close(pipe_ends[1]);
  std::string said;
  char letter = 0;
  while (read(pipe_ends[0], &letter, 1) == 1) said += letter;
  close(pipe_ends[0]);
  return wait_for(child) == 0 ? said : "ended early: " + said;
}

std::string lines_of(const std::vector<HostileCall>& calls) {
  std::string lines;
  for (const HostileCall& call : calls) lines += std::string(call.name) + ": " + std::to_string(call.error) + "\n";
  return lines;
}

/// Checks that each line ends in one of the errors that are refusals.
void expect_refused(const std::string& lines, std::size_t least) {
  std::istringstream text(lines);
  std::size_t count = 0;
  for (std::string line; std::getline(text, line); ++count) {
    const std::string error = line.substr(line.rfind(' ') + 1);
    EXPECT_TRUE(error == std::to_string(EPERM) || error == std::to_string(EACCES) || error == std::to_string(EXDEV))
        << line;
  }
  EXPECT_GE(count, least) << lines;
}

class Sandbox : public testing::Test {
 protected:
  void SetUp() override {
    const std::string has = sandbox_text();
    if (has.find("seccomp") == std::string::npos || has.find("landlock") == std::string::npos)
      GTEST_SKIP() << "this build and kernel have: " << has;
    for (const char* name : {"inside", "outside", "read"}) fs::create_directories(at(name));
    for (const char* name : {"inside/file", "outside/secret", "read/secret"}) std::ofstream(at(name)) << "text";
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Reach reach() const { return {{"/usr", "/lib", "/lib64", "/proc", at("read")}, {at("inside")}}; }

  ScratchFolder folder_{"sandbox"};
};

TEST_F(Sandbox, refuses_calls_that_a_renderer_has_no_use_for) {
  expect_refused(said_within(reach(), [] { return lines_of(hostile_calls()); }), 32);
}

TEST_F(Sandbox, refuses_files_out_of_reach) {
  expect_refused(said_within(reach(), [&] { return lines_of(hostile_file_calls(at("outside"))); }), 8);
  std::ifstream secret(at("outside/secret"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(secret), {}), "text");
}

TEST_F(Sandbox, refuses_to_write_what_is_only_readable) {
  std::vector<HostileCall> calls;
  const std::string said = said_within(reach(), [&] {
    calls = hostile_file_calls(at("read"));
    std::erase_if(calls, [](const HostileCall& call) {
      const std::string_view name = call.name;
      return call.error == 0 && (name == "read a file" || name == "list a folder");
    });
    return lines_of(calls);
  });
  expect_refused(said, 6);
  EXPECT_EQ(said.find("read a file"), std::string::npos);
}

TEST_F(Sandbox, refuses_ways_out_of_a_writable_folder) {
  expect_refused(
      said_within(reach(),
                  [&] {
                    const std::string secret = at("outside/secret"), link = at("inside/link");
                    return lines_of(
                        {{"link", error_of(::link(secret.c_str(), link.c_str()))},
                         {"symlink", error_of(::symlink(secret.c_str(), link.c_str()))},
                         {"move in", error_of(::rename(secret.c_str(), link.c_str()))},
                         {"move out", error_of(::rename(at("inside/file").c_str(), at("outside/file").c_str()))}});
                  }),
      4);
}

TEST_F(Sandbox, leaves_threads_and_files_within_reach) {
  const std::string said = said_within(reach(), [&] {
    const auto read_it = [&] {
      const Bytes bytes = read_file(at("read/secret"));
      return std::string(text_of(bytes));
    };
    std::string text = std::async(std::launch::async, read_it).get();
    make_folders(at("inside/a/b"));
    write_file(at("inside/a/b/new"), bytes_of("new"));
    write_file(at("inside/a/b/new"), bytes_of("newer"));
    if (rename(at("inside/a/b/new").c_str(), at("inside/new").c_str()) != 0) text += " no rename";
    if (raise(0) != 0 || kill(getpid(), 0) != 0) text += " no signal";
    if (dlopen("libz.so.1", RTLD_NOW) == nullptr) text += " no library";
    const Bytes bytes = read_file(at("inside/new"));
    return text + " " + std::string(text_of(bytes));
  });
  EXPECT_EQ(said, "text newer");
}

/// The program in the sandbox.
class SandboxedProgram : public Sandbox {
 protected:
  void SetUp() override {
    Sandbox::SetUp();
    if (IsSkipped()) return;
    fs::copy(kScenes / "spheres", at("scene"), fs::copy_options::recursive);
    fs::copy_file(kScenes / "spheres.png", at("paint.png"));
    std::ofstream(at("j.json")) << R"({"relook": "journal/1", "steps": [
      {"name": "picture", "edit": [{"op": "add", "path": "/images/New", "value": {"uri": "paint.png"}}]},
      {"name": "dim", "edit": [{"op": "replace", "path": "/lights/Lamp/intensity", "value": 20}]}]})";
  }
  ProgramResult relook(std::vector<std::string> words, std::vector<std::string> before = {}) const {
    before.emplace_back(RELOOK_PROGRAM);
    before.insert(before.end(), words.begin(), words.end());
    before.emplace_back("--quiet");
    return run_program(before);
  }
  /// Of a command line as a shell in the test's folder reads it; $R is the program, $S makes it quick.
  ProgramResult shell(const std::string& line) const {
    return run_program({"env", std::string("R=") + RELOOK_PROGRAM, "S=--resolution 16x9 --quiet", "bash", "-c",
                        "cd '" + at("") + "' && " + line});
  }
  void expect_done(const ProgramResult& result) const { EXPECT_EQ(result.exit_code, 0) << result.output; }
  void make_cache() const {
    expect_done(relook({"preprocess", at("scene/spheres.gltf"), "-o", at("c"), "--resolution", "40x24"}));
  }
};

TEST_F(SandboxedProgram, refuses_what_a_fault_in_it_would_be_used_for) {
  const std::vector<std::string> shim{"env", std::string("LD_PRELOAD=") + RELOOK_HOSTILE_SHIM,
                                      "RELOOK_HOSTILE_AT=spheres.gltf", "RELOOK_HOSTILE_FOLDER=" + at("outside")};
  const auto hostile = [&](std::vector<std::string> before) {
    fs::create_directories(at("out"));
    const ProgramResult result =
        relook({"render", at("scene/spheres.gltf"), "-o", at("out/f.exr"), "--resolution", "16x9"}, std::move(before));
    expect_done(result);
    std::string lines;
    std::istringstream text(result.output);
    for (std::string line; std::getline(text, line);)
      if (line.starts_with("hostile: ")) lines += line + "\n";
    return lines;
  };
  expect_refused(hostile(shim), 40);
  std::vector<std::string> without = shim;
  without.emplace_back("RELOOK_SANDBOX=off");
  EXPECT_NE(hostile(without).find("hostile: read a file: 0\n"), std::string::npos) << "the shim can attack";
}

TEST_F(SandboxedProgram, reads_and_writes_whatever_way_files_are_named) {
  make_cache();
  fs::create_directories(at("links"));
  fs::create_symlink(at("scene/spheres.gltf"), at("scene/linked.gltf"));
  fs::create_directory_symlink(at("scene"), at("links/scene"));
  fs::create_directory_symlink(at("c"), at("links/c"));
  fs::create_symlink(at("j.json"), at("plain.json"));
  fs::create_directories(at("disk"));
  fs::create_directory_symlink(at("disk"), at("links/disk"));
  fs::create_directories(at("far"));
  for (const char* name : {"j.json", "paint.png"}) fs::copy_file(at(name), at("far/") + name);
  fs::copy_file(at("j.json"), at("other.json"));
  std::ofstream(at("dim.json")) << R"({"relook": "journal/1", "steps": [{"name": "dim", "edit": [
      {"op": "replace", "path": "/lights/Lamp/intensity", "value": 20}]}]})";
  const std::vector<std::string> lines{
      "$R render scene/spheres.gltf -o f.exr $S",
      "$R render scene/linked.gltf -o links/disk/a/b/c/f.exr $S",
      "$R render links/scene/spheres.gltf -o ./new/../new/f.exr $S",
      "cd scene && $R render spheres.gltf -o ../up.png $S",
      "cd scene && $R render ../links/scene/linked.gltf -o $PWD/../deep/er/f.png --trace race.json $S",
      "$R render scene/spheres.gltf -o g.exr --journal - $S < j.json",
      "$R render scene/spheres.gltf -o g.exr --journal plain.json $S",
      "$R render scene/spheres.gltf -o g.exr --journal /dev/stdin $S < dim.json",
      "$R preprocess scene/spheres.gltf -o links/disk/new/c/ $S",
      "$R preprocess scene/spheres.gltf -o links/disk/new/c $S",
      "$R preprocess scene/spheres.gltf -o links/disk/new/c --overwrite --samples 2 $S",
      "$R replay links/c j.json -o runs/of/night --verify --quiet",
      "$R replay links/c - -o runs/stdin --quiet < j.json",
      "$R replay c/ far/j.json other.json -o links/disk/runs --quiet",
      "mkdir here && cd here && $R replay ../c ../j.json -o . --quiet",
      "mkdir spill && $R replay c j.json -o runs/spilt --spill spill --memory 600M --access-log log.txt --quiet",
      "$R tune log.txt --quiet",
      "$R check links/c --quiet",
      "$R plan c j.json --json plan.json --quiet",
      "$R compare runs/of/night runs/stdin -o page/of/it --quiet",
      "$R compare g.exr g.exr --json=same.json --html same.html --exact --quiet",
      "$R replay c far/j.json -o far/run --quiet && $R blame far/run 3,3 --quiet",
      "mv far moved && $R blame moved/run 3,3 --cache links/c --journal moved/j.json --quiet",
      "$R journal wedge scene/spheres.gltf /lights/Lamp/intensity 5 10 -o wedge.json --quiet",
      "$R inspect scene/spheres.gltf --look > look.txt",
      "$R inspect moved/j.json --scene links/c --quiet",
      "$R inspect moved/run && $R inspect links/c",
      "t=$(mktemp -d /dev/shm/relook.XXXXXX) && cp -r scene paint.png j.json $t && $R render $t/scene/spheres.gltf -o "
      "f.exr $S"
      " && $R replay c $t/j.json -o runs/shm --quiet; r=$?; rm -rf $t; exit $r",
      "$R replay c j.json other.json -o runs/two --quiet && mkdir -p a1 b1 && mv runs/two/other/frames a1/F &&"
      " ln -s $PWD/a1/F runs/two/other/frames && mv runs/two/other b1/O && ln -s $PWD/b1/O runs/two/other &&"
      " $R replay c j.json other.json -o runs/two --fresh --quiet"};
  for (const std::string& line : lines) {
    SCOPED_TRACE(line);
    expect_done(shell(line));
  }
}

TEST_F(SandboxedProgram, follows_links_in_the_folders_that_it_is_given) {
  make_cache();
  expect_done(relook({"replay", at("c"), at("j.json"), "-o", at("run")}));
  fs::create_directories(at("far/away"));
  fs::rename(at("run/frames"), at("far/away/frames"));
  fs::create_directory_symlink(at("far/away/frames"), at("run/frames"));
  fs::create_directories(at("plates"));
  for (const auto& frame : fs::directory_iterator(at("far/away/frames")))
    fs::create_symlink(frame.path(), at("plates") + "/" + frame.path().filename().string());
  expect_done(relook({"compare", at("run"), at("plates")}));
  expect_done(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--fresh"}));
}

TEST_F(SandboxedProgram, finds_the_tables_of_a_display_view) {
  for (const char* name : {"views", "tables", "out"}) fs::create_directories(at(name));
  std::ofstream(at("tables/half.cube")) << "LUT_1D_SIZE 2\n0 0 0\n0.5 0.5 0.5\n";
  for (const char* places : {"\"luts:../tables\"", "\n  - luts\n  - ../tables"}) {
    std::ofstream(at("views/config.ocio")) << "ocio_profile_version: 2\nsearch_path: " << places << R"(
roles: {default: raw, scene_linear: linear}
displays:
  Wall:
    - !<View> {name: Half, colorspace: half}
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: linear}
  - !<ColorSpace>
    name: half
    from_scene_reference: !<FileTransform> {src: half.cube, interpolation: linear}
)";
    expect_done(relook({"render", at("scene/spheres.gltf"), "-o", at("out/f.png"), "--resolution", "16x9"},
                       {"env", "OCIO=" + at("views/config.ocio")}));
  }
}

TEST_F(SandboxedProgram, still_refuses_an_output_deep_inside_a_cache) {
  make_cache();
  const ProgramResult result = relook({"render", kScene, "-o", at("c/a/b/f.exr")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find("lies inside the cache"), std::string::npos) << result.output;
}

TEST(SandboxText, is_a_line_of_the_version) {
  const ProgramResult version = run_program({RELOOK_PROGRAM, "--version"});
  EXPECT_TRUE(version.output.ends_with("\nsandbox: " + sandbox_text() + "\n")) << version.output;
}

}  // namespace
}  // namespace relook
