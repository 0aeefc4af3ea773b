// Folders that a cache is written to or lies in: what is in the way is told apart by its content, and only files that
// relook wrote are ever removed.
#include "cache/cache_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <map>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/file_names.h"
#include "base/hash.h"
#include "base/json.h"
#include "cache/arithmetic.h"
#include "cache/cache_names.h"
#include "run_program.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

const std::string kSomeHash(32, '7');

void expect_line(const ProgramResult& result, int code, const std::string& part) {
  EXPECT_EQ(result.exit_code, code) << result.output;
  EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
  EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
}

void write_text(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

/// Hashes of all files below a folder, hidden ones too.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = hash128(read_file(entry.path()));
  return files;
}

const std::vector<std::string> kDroppings{".DS_Store",    "Thumbs.db",  "desktop.ini",     "._look.json",
                                          ".nfs0000a1b2", ".directory", "trees/.DS_Store", "trees/.nfs00ff"};

class CacheFolder : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  /// As it is taken by most tests.
  [[nodiscard]] ProgramResult preprocess(const std::string& output, std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"preprocess", kScene, "-o", at(output), "--integrator", "whitted", "--resolution",
                                 "40x24", "--progress", "none"});
    return relook(flags);
  }
  void make_cache() const {
    const ProgramResult made = preprocess("c");
    ASSERT_EQ(made.exit_code, 0) << made.output;
  }
  /// Rewrites the manifest so that it is sound for its changed document.
  template <class Change>
  void change_manifest(const Change& change) const {
    Json document = parse_json(text_of(read_file(at("c/MANIFEST.json"))), "MANIFEST.json");
    change(document);
    document["hash"] = hash128(bytes_of(document["content"].dump()));
    write_text(at("c/MANIFEST.json"), document.dump(1) + "\n");
  }
  void leave_droppings() const {
    for (const std::string& name : kDroppings) write_text(at("c/" + name), "left by the system");
  }
  ScratchFolder folder_{"cache_folder"};
};

TEST(CacheNames, are_those_that_a_cache_is_written_with) {
  for (const std::string& name :
       {std::string("MANIFEST.json"), std::string("look.json"), "geometry-" + kSomeHash + ".rlk",
        "trees/00012-" + kSomeHash + ".rlk", std::string(".look.json.12.0.tmp"),
        "trees/.00012-" + kSomeHash + ".rlk.4711.3.tmp", ".paths-" + kSomeHash + ".rlk.1.2.tmp"})
    EXPECT_TRUE(is_own_name(name)) << name;
  for (const std::string& name :
       {std::string("look.json2"), std::string("frames"), "plates-" + kSomeHash + ".rlk",
        std::string("geometry-77.rlk"), "trees/a-" + kSomeHash + ".rlk", "trees/x/1-" + kSomeHash + ".rlk",
        "other/1-" + kSomeHash + ".rlk", std::string(".look.json.tmp"), std::string(".look.json.x.0.tmp"),
        std::string(".notes.1.2.tmp"), std::string("trees/look.json"), std::string("trees/.look.json.1.2.tmp"),
        std::string("")})
    EXPECT_FALSE(is_own_name(name)) << name;
  for (const char* name : {".nfs", ".nfsplates", "._", "DS_Store", "Thumbs.db.txt"}) EXPECT_FALSE(is_system_name(name));
  for (const char* name : {"thumbs.db", "Desktop.ini", "._plate.exr"}) EXPECT_TRUE(is_system_name(name));
}

TEST_F(CacheFolder, the_same_command_again_says_that_the_cache_is_complete) {
  make_cache();
  const auto before = contents(at("c"));
  const ProgramResult again = preprocess("c");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.output.find("complete already"), std::string::npos) << again.output;
  const ProgramResult json = preprocess("c", {"--json"});
  const Json result = parse_json(json.output, "output");
  EXPECT_EQ(result["complete"], true);
  EXPECT_EQ(result["resolution"], Json({40, 24}));
  EXPECT_EQ(contents(at("c")), before);
  fs::create_directory_symlink(at("c"), at("link"));
  EXPECT_EQ(preprocess("link").exit_code, 0);
  EXPECT_EQ(preprocess("c/").exit_code, 0);
  EXPECT_EQ(preprocess("c/../c").exit_code, 0);
}

TEST_F(CacheFolder, another_cache_is_replaced_only_when_asked) {
  make_cache();
  const auto before = contents(at("c"));
  write_text(at("look.json"), R"([{"op": "replace", "path": "/scene/extras/relook/ambient", "value": [0.5, 0, 0]}])");
  struct Other {
    std::vector<std::string> flags;
    const char* what;
  };
  const Other others[] = {{{"--resolution", "50x30"}, "of another resolution (40x24); --overwrite replaces it"},
                          {{"--samples", "4"}, "of another --samples (1);"},
                          {{"--max-depth", "3"}, "of another --max-depth (6);"},
                          {{"--shadow-bits", "2"}, "of another --shadow-bits (0);"},
                          {{"--ray-trees", "50"}, "of another --ray-trees (100);"},
                          {{"--disk", "64M"}, "of another --disk (none);"},
                          {{"--camera", "0,2,9:0,1,0:30"}, "of another camera ("},
                          {{"--look", at("look.json")}, "of another scene;"},
                          {{"--look", at("look.json"), "--samples", "2", "--resolution", "8x8"},
                           "of another scene, resolution (40x24) and --samples (1);"}};
  for (const Other& other : others) {
    std::vector<std::string> command{"preprocess",   kScene,    "-o",         at("c"),
                                     "--integrator", "whitted", "--progress", "none"};
    if (std::ranges::find(other.flags, "--resolution") == other.flags.end())
      command.insert(command.end(), {"--resolution", "40x24"});
    command.insert(command.end(), other.flags.begin(), other.flags.end());
    expect_line(relook(command), 1, at("c") + ": holds a cache " + other.what);
    EXPECT_EQ(contents(at("c")), before) << other.what;
  }
  EXPECT_EQ(preprocess("c", {"--samples", "2", "--overwrite"}).exit_code, 0);
  expect_line(preprocess("c"), 1, "--samples (2)");
  EXPECT_EQ(preprocess("c", {"--samples", "2"}).exit_code, 0);
  EXPECT_EQ(relook({"check", at("c"), "--quiet"}).exit_code, 0);
}

TEST_F(CacheFolder, a_cache_that_does_not_fit_is_in_the_way_by_its_own_name) {
  const auto expect_in_the_way = [&](const std::string& what) {
    const auto before = contents(at("c"));
    expect_line(preprocess("c"), 1, at("c") + ": holds a " + what);
    EXPECT_EQ(contents(at("c")), before);
    EXPECT_EQ(preprocess("c", {"--overwrite"}).exit_code, 0);
    EXPECT_EQ(relook({"check", at("c"), "--quiet"}).exit_code, 0);
    EXPECT_EQ(std::distance(fs::directory_iterator(at("")), {}), 1) << "temporary folders remain";
  };
  make_cache();
  change_manifest([](Json& document) { document["relook"] = "cache/1"; });
  expect_in_the_way("cache of another version (its format is cache/1, this program reads cache/6); --overwrite");
  change_manifest([](Json& document) { document["content"]["arithmetic"]["embree"] = "3.12.1"; });
  expect_in_the_way("cache written with Embree 3.12.1, this is " + own_arithmetic().embree + "; --overwrite");
  fs::resize_file(at("c/MANIFEST.json"), 100);
  expect_in_the_way("damaged cache (MANIFEST.json: the manifest does not end)");
  fs::remove(at("c/MANIFEST.json"));
  expect_in_the_way("damaged cache (no MANIFEST.json)");
  fs::resize_file(at("c/look.json"), 10);
  expect_in_the_way("damaged cache (look.json: ");
  for (const auto& entry : fs::directory_iterator(at("c/trees"))) {
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200).put('!');
  }
  expect_in_the_way("damaged cache (trees/00000-");
}

TEST_F(CacheFolder, what_relook_did_not_write_is_never_replaced) {
  make_cache();
  struct Foreign {
    std::string output, what;
  };
  std::vector<Foreign> table;
  const auto add = [&](const std::string& output, const std::string& file, const std::string& what) {
    write_text(at(output + "/" + file), "mine");
    table.push_back({output, what});
  };
  add("plates", "plate.exr", "holds plate.exr, which relook did not write");
  add("frames", "frames/0001.exr", "holds frames, which relook did not write");
  add("looks", "look.json", "holds look.json, but no cache");
  add("named", "MANIFEST.json", "holds MANIFEST.json, but no cache");
  add("quoting", "notes/relook.txt", "holds notes, which relook did not write");
  write_text(at("quoting/MANIFEST.json"), R"({"text": "about \"relook\": \"cache/2\""})"
                                          "\n");
  add("trees", "trees/oak.png", "holds trees/oak.png, which relook did not write");
  add("run", "report.json", "holds a run, not a cache");
  write_text(at("run/report.json"), R"({"relook": "report/1"})");
  fs::copy(at("c"), at("mixed"), fs::copy_options::recursive);
  add("mixed", "notes.txt", "");
  fs::copy(at("c"), at("deep"), fs::copy_options::recursive);
  add("deep", "trees/notes.txt", "");
  fs::copy(at("c"), at("linked"), fs::copy_options::recursive);
  fs::create_symlink(at("plates/plate.exr"), at("linked/geometry-" + kSomeHash + ".rlk"));
  table.push_back({"linked", ""});
  write_text(at("file.exr"), "mine");
  table.push_back({"file.exr", "is a file, not a folder"});
  fs::create_symlink(at("nowhere"), at("dangling"));
  table.push_back({"dangling", "is a link to nothing"});
  fs::create_directory_symlink(at("plates"), at("to_plates"));
  table.push_back({"to_plates", "holds plate.exr"});
  table.push_back({"plates/../plates/.", "holds plate.exr"});
  ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
  table.push_back({"pipe", "is not a folder"});
  table.push_back({"c/sub/cache", "lies inside the cache"});
  fs::create_symlink(at("c/run"), at("into"));
  table.push_back({"into/deeper", "lies inside the cache"});
  const auto before = contents(at(""));
  for (const Foreign& foreign : table) {
    SCOPED_TRACE(foreign.output);
    expect_line(preprocess(foreign.output, {"--overwrite"}), 1,
                foreign.what.empty() ? ", which relook did not write" : foreign.what);
    expect_line(preprocess(foreign.output, {"--samples", "2"}), 1,
                foreign.what.empty() ? "holds a cache of another --samples" : foreign.what);
    EXPECT_EQ(contents(at("")), before);
  }
  expect_line(relook({"preprocess", kScene, "-o", "/dev/null", "--overwrite"}), 1, "is a device, not a folder");
}

TEST_F(CacheFolder, what_systems_leave_is_neither_a_fault_nor_removed) {
  make_cache();
  leave_droppings();
  const ProgramResult checked = relook({"check", at("c"), "--json"});
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  const Json report = parse_json(checked.output, "output");
  EXPECT_EQ(report["sound"], true);
  EXPECT_TRUE(report["findings"].empty());
  EXPECT_EQ(report["notes"].size(), kDroppings.size());
  EXPECT_EQ(preprocess("c").exit_code, 0) << "it is complete";
  EXPECT_EQ(preprocess("c", {"--samples", "2", "--overwrite"}).exit_code, 0);
  for (const std::string& name : kDroppings) EXPECT_TRUE(fs::exists(at("c/" + name))) << name;
  EXPECT_EQ(relook({"check", at("c"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(at("")), {}), 1) << "temporary folders remain";
  write_text(at("c/notes.txt"), "mine");
  EXPECT_EQ(relook({"check", at("c"), "--quiet"}).exit_code, 5);

  write_text(at("empty/.DS_Store"), "left by the system");
  EXPECT_EQ(preprocess("empty").exit_code, 0) << "a folder with nothing in it";
  EXPECT_TRUE(fs::exists(at("empty/.DS_Store")));
  EXPECT_EQ(relook({"check", at("empty"), "--quiet"}).exit_code, 0);
}

TEST_F(CacheFolder, only_what_killed_writers_left_is_cleared_away) {
  const std::string rlk = "frame-" + kSomeHash + ".rlk";
  for (const char* abandoned : {".c.relook-99999999-0", ".c.relook-99999999-1", ".c.relook-99999999-0-old",
                                ".c.relook-notes", ".d.relook-99999999-0"})
    write_text(at(std::string(abandoned) + "/" + rlk), "half");
  write_text(at(".c.relook-99999999-0/trees/.00000-" + kSomeHash + ".rlk.99999999.0.tmp"), "half");
  write_text(at(".c.relook-99999999-1/painting.kra"), "mine");
  make_cache();
  EXPECT_FALSE(fs::exists(at(".c.relook-99999999-0")));
  EXPECT_EQ(contents(at(".c.relook-99999999-1")).size(), 1U);
  EXPECT_TRUE(fs::exists(at(".c.relook-99999999-1/painting.kra")));
  EXPECT_TRUE(fs::exists(at(".c.relook-99999999-0-old/" + rlk)));
  EXPECT_TRUE(fs::exists(at(".c.relook-notes/" + rlk)));
  EXPECT_TRUE(fs::exists(at(".d.relook-99999999-0/" + rlk)));
}

TEST_F(CacheFolder, the_cache_around_a_path_is_found) {
  make_cache();
  const fs::path cache = fs::canonical(at("c"));
  for (const char* inside : {"c", "c/", "c/trees", "c/run", "c/run/deeper/x.exr", "c/./run/../other"})
    EXPECT_EQ(enclosing_cache(at(inside)), cache) << inside;
  for (const char* outside : {"run", "c/../run", "cc", "c.exr"})
    EXPECT_EQ(enclosing_cache(at(outside)), std::nullopt) << outside;
  fs::create_directory_symlink(at("c"), at("link"));
  EXPECT_EQ(enclosing_cache(at("link/run")), cache);
  fs::create_symlink("c/not/there", at("dangling"));
  EXPECT_EQ(enclosing_cache(at("dangling/run")), cache);
  fs::create_symlink("loop", at("loop"));
  EXPECT_EQ(enclosing_cache(at("loop/run")), std::nullopt);
  fs::resize_file(at("c/MANIFEST.json"), 10);
  EXPECT_EQ(enclosing_cache(at("c/run")), cache) << "a damaged cache is one";
}

/// Runs relook as nobody, who owns nothing.
std::optional<ProgramResult> relook_as_nobody(std::vector<std::string> arguments) {
  const std::vector<std::string> drop{"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"};
  std::vector<std::string> trial = drop;
  trial.insert(trial.end(), {RELOOK_PROGRAM, "--version"});
  if (run_program(trial).exit_code != 0) return std::nullopt;
  arguments.insert(arguments.begin(), RELOOK_PROGRAM);
  arguments.insert(arguments.begin(), drop.begin(), drop.end());
  return run_program(arguments);
}

TEST_F(CacheFolder, what_may_not_be_read_is_neither_missing_nor_damaged) {
  make_cache();
  write_text(at("j.json"), R"({"relook": "journal/1", "steps": []})");
  fs::permissions(at(""), fs::perms::all);
  std::string tree;
  for (const auto& entry : fs::directory_iterator(at("c/trees"))) tree = "c/trees/" + entry.path().filename().string();
  for (const std::string& name :
       {std::string("c"), std::string("c/trees"), std::string("c/MANIFEST.json"), std::string("c/look.json"), tree}) {
    SCOPED_TRACE(name);
    const fs::perms kept = fs::status(at(name)).permissions();
    fs::permissions(at(name), fs::perms::none);
    for (const char* verb : {"check", "replay", "inspect"}) {
      SCOPED_TRACE(verb);
      std::vector<std::string> command{verb, at("c")};
      if (verb == std::string("replay")) command.insert(command.end(), {at("j.json"), "-o", at("run"), "--quiet"});
      if (verb == std::string("inspect") && name != "c" && name != "c/MANIFEST.json") continue;
      const std::optional<ProgramResult> result = relook_as_nobody(command);
      if (!result) GTEST_SKIP() << "SKIPPED: privileges cannot be dropped here; unreadable caches are NOT tested";
      EXPECT_EQ(result->exit_code, 6) << result->output;
      EXPECT_NE(result->output.find("Permission denied"), std::string::npos) << result->output;
      EXPECT_FALSE(fs::exists(at("run")));
    }
    if (name == "c" || name == "c/trees") {
      const auto refused = relook_as_nobody({"preprocess", kScene, "-o", at("c"), "--overwrite"});
      expect_line(*refused, 6, "Permission denied");
    }
    fs::permissions(at(name), kept);
  }
  EXPECT_EQ(relook_as_nobody({"check", at("c"), "--quiet"})->exit_code, 0);
}

TEST_F(CacheFolder, caches_of_equal_arithmetic_are_exchangeable_and_others_say_what_differs) {
  make_cache();
  write_text(at("j.json"), R"({"relook": "journal/1", "steps": []})");
  const Arithmetic own = own_arithmetic();
  const Json kept = parse_json(text_of(read_file(at("c/MANIFEST.json"))), "MANIFEST.json");
  EXPECT_EQ(kept["content"]["arithmetic"], arithmetic_json(own));
  struct Other {
    const char* key;
    Json value;
    std::string what;
  };
  const Other others[] = {
      {"version", own.version + 1,
       "written with arithmetic " + std::to_string(own.version + 1) + ", this is " + std::to_string(own.version)},
      {"embree", "3.12.1", "written with Embree 3.12.1, this is " + own.embree},
      {"libc", "glibc 2.17", "written with glibc 2.17, this is " + own.libc},
      {"instructions", "mmx", "written with instructions mmx, this is " + own.instructions}};
  for (const Other& other : others) {
    change_manifest([&](Json& document) { document["content"]["arithmetic"][other.key] = other.value; });
    expect_line(relook({"replay", at("c"), at("j.json"), "-o", at("run")}), 3,
                "relook: " + at("c") + ": MANIFEST.json: " + other.what + "; preprocess again");
    EXPECT_FALSE(fs::exists(at("run")));
    change_manifest([&](Json& document) { document = kept; });
  }
  EXPECT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  Arithmetic two = own;
  two.embree = "3.12.1";
  two.libc = "glibc 2.17";
  EXPECT_EQ(arithmetic_difference(two, own),
            "written with Embree 3.12.1, this is " + own.embree + "; with glibc 2.17, this is " + own.libc);
  EXPECT_EQ(arithmetic_difference(own, own), "");
}

TEST_F(CacheFolder, the_version_says_what_bits_depend_on) {
  const Arithmetic& own = own_arithmetic();
  const std::string version = relook({"--version"}).output;
  EXPECT_TRUE(version.starts_with("relook 0.1.0\narithmetic " + std::to_string(own.version) + ", Embree " + own.embree +
                                  ", " + own.libc + ", " + own.instructions + "\ncache format 6\n"))
      << version;
  EXPECT_NE(own.embree, "none");
}

}  // namespace
}  // namespace relook
