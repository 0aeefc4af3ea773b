// --integrator, --diffuse-depth, --glossy-depth and --transmission-depth: which verbs take them, what they are where
// they are not said, what is refused beside them, and that a cache, its replays and their reports are of one
// integrator.
#include "cli_fixture.h"

namespace relook {
namespace {

class IntegratorCli : public Cli {
 protected:
  /// A cache of Integrator::path.
  ProgramResult preprocess_path(const std::string& output, std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"preprocess", kScene, "-o", at(output), "--resolution", "24x16", "--quiet",
                                 "--integrator", "path"});
    return relook(flags);
  }
  ProgramResult replay(const std::string& cache, const std::string& run, std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"replay", at(cache), at("j.json"), "-o", at(run), "--quiet"});
    return relook(flags);
  }
  void write_journal() const { write_text(at("j.json"), R"({"relook": "journal/1", "steps": []})"); }
};

TEST_F(IntegratorCli, path_with_64_samples_and_two_diffuse_bounces_is_what_is_rendered) {
  ASSERT_EQ(relook({"render", kScene, "-o", at("usual.exr"), "--resolution", "24x16", "--quiet"}).exit_code, 0);
  const std::vector<std::string> said{"--integrator",   "path", "--samples",   "64", "--diffuse-depth",      "2",
                                      "--glossy-depth", "4",    "--max-depth", "6",  "--transmission-depth", "16"};
  std::vector<std::string> words{"render", kScene, "-o", at("said.exr"), "--resolution", "24x16", "--quiet"};
  words.insert(words.end(), said.begin(), said.end());
  ASSERT_EQ(relook(words).exit_code, 0);
  EXPECT_EQ(read_file(at("usual.exr")), read_file(at("said.exr")));
  words.insert(words.end(), {"--overwrite", "--samples", "63"});
  words.erase(std::ranges::find(words, "64") - 1, std::ranges::find(words, "64") + 1);
  ASSERT_EQ(relook(words).exit_code, 0);
  EXPECT_NE(read_file(at("usual.exr")), read_file(at("said.exr")));
  const auto samples_of = [&](const std::string& integrator) {
    return parse_json(relook({"render", kScene, "-o", at(integrator + ".exr"), "--resolution", "24x16", "--json",
                              "--progress", "none", "--integrator", integrator})
                          .output,
                      "stdout");
  };
  EXPECT_EQ(samples_of("whitted")["samples_total"], 24 * 16);
  EXPECT_TRUE(samples_of("whitted")["noise"].is_null());
  EXPECT_EQ(samples_of("path")["samples_total"], 24 * 16 * 64);
  EXPECT_GT(samples_of("path")["noise"], 0);
}

TEST_F(IntegratorCli, depths_are_for_path_alone) {
  for (const char* option : {"--diffuse-depth", "--glossy-depth", "--transmission-depth"}) {
    for (const char* verb : {"render", "preprocess"})
      expect_error(relook({verb, kScene, "-o", at("x.exr"), option, "1", "--integrator", "whitted"}), 1,
                   std::string(verb) + " " + option + ": it is for --integrator path");
    expect_error(relook({"render", kScene, "-o", at("x.exr"), option, "17", "--integrator", "path"}), 1, option);
  }
  expect_error(relook({"render", kScene, "-o", at("x.exr"), "--integrator", "pat"}), 1, "--integrator");
  expect_error(relook({"plan", at("c"), at("j"), "--integrator", "path"}), 1, "plan takes no --integrator");
}

/// Scripts give the same options to all caches.
TEST_F(IntegratorCli, structures_that_path_has_none_of_are_named_in_a_warning) {
  const std::vector<std::vector<std::string>> asked{
      {"--tunnels", "1"}, {"--groups", "4"}, {"--shadow-bits", "2"}, {"--color-trees", "50"}, {"--atoms", "2"}};
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(preprocess_path("plain").exit_code, 0);
  ASSERT_EQ(replay("plain", "expected", {"--float"}).exit_code, 0);
  for (const auto& flags : asked) {
    const auto expect_warning = [&](std::vector<std::string> words) {
      words.insert(words.end(), {flags[0], flags[1], "--overwrite", "--progress", "none"});
      const ProgramResult result = relook(words);
      EXPECT_EQ(result.exit_code, 0) << result.output;
      EXPECT_NE(result.output.find("warning: " + flags[0] + ": of --integrator whitted alone"), std::string::npos)
          << result.output;
    };
    expect_warning({"preprocess", kScene, "-o", at("c"), "--resolution", "24x16"});
    expect_warning({"replay", at("c"), at("j.json"), "-o", at("r"), "--float", "--verify"});
    EXPECT_EQ(read_file(at("r/frames/0002_02.exr")), read_file(at("expected/frames/0002_02.exr")));
    const Json options = read_json(at("r/report.json"))["options"];
    for (const char* none : {"tunnels", "groups", "color_trees", "atoms", "shadow_bits"}) EXPECT_EQ(options[none], 0);
  }
  const ProgramResult none =
      relook({"preprocess", kScene, "-o",          at("none"), "--resolution",  "24x16", "--progress",    "none",
              "--tunnels",  "0",    "--groups",    "0",        "--shadow-bits", "0",     "--color-trees", "0",
              "--atoms",    "0",    "--ray-trees", "100"});
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_EQ(none.output.find("warning"), std::string::npos) << "to ask for none is no fault";
}

TEST_F(IntegratorCli, overlays_show_the_squares_that_change_and_a_run_with_them_is_complete) {
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(preprocess_path("c").exit_code, 0);
  ASSERT_EQ(replay("c", "r", {"--overlays"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(at("r/overlays/0001_dependent.png")));
  EXPECT_FALSE(std::filesystem::exists(at("r/progress.jsonl"))) << "all is in the report";
  EXPECT_NE(relook({"replay", at("c"), at("j.json"), "-o", at("r"), "--overlays"}).output.find("complete"),
            std::string::npos);
}

TEST_F(IntegratorCli, ray_trees_that_are_not_kept_change_no_frame) {
  write_text(at("j.json"), kJournal);
  const auto make = [&](const std::string& name, std::vector<std::string> flags) {
    const std::vector<std::string> large{"--resolution", "200x72", "--samples", "2"};  // several tiles
    flags.insert(flags.end(), {"--integrator", "path", "--quiet"});
    flags.insert(flags.end(), large.begin(), large.end());
    flags.insert(flags.begin(), {"preprocess", kScene, "-o", at(name)});
    ASSERT_EQ(relook(flags).exit_code, 0);
    ASSERT_EQ(replay(name, name + "_run", {"--float", "--verify"}).exit_code, 0);
  };
  make("all", {});
  make("some", {"--ray-trees", "40"});
  make("none", {"--ray-trees", "0"});
  ASSERT_EQ(replay("all", "dropped_run", {"--float", "--ray-trees", "30"}).exit_code, 0);
  for (const std::string frame : {"0000", "0001", "0002_01", "0002_02"})
    for (const std::string run : {"some", "none", "dropped"})
      EXPECT_EQ(read_file(at(run + "_run/frames/" + frame + ".exr")), read_file(at("all_run/frames/" + frame + ".exr")))
          << run << " " << frame;
  const auto trees = [&](const std::string& name) {
    return read_json(at(name + "/MANIFEST.json"))["content"]["pieces"]["ray_trees"].get<std::uint64_t>();
  };
  EXPECT_GT(trees("all"), trees("some"));
  EXPECT_GT(trees("some"), trees("none"));
}

TEST_F(IntegratorCli, a_replay_is_of_the_integrator_of_its_cache) {
  write_journal();
  ASSERT_EQ(preprocess_path("path", {"--diffuse-depth", "1", "--glossy-depth", "2", "--transmission-depth", "3"}).exit_code, 0);
  ASSERT_EQ(preprocess("whitted").exit_code, 0);
  expect_error(replay("path", "r", {"--integrator", "whitted"}), 3,
               "the cache is of --integrator path; preprocess again with --integrator whitted");
  expect_error(replay("whitted", "r", {"--integrator", "path"}), 3, "the cache is of --integrator whitted");
  EXPECT_FALSE(std::filesystem::exists(at("r")));
  ASSERT_EQ(replay("path", "paths", {"--integrator", "path", "--verify"}).exit_code, 0);
  ASSERT_EQ(replay("whitted", "lamps").exit_code, 0);
  const Json paths = read_json(at("paths/report.json"))["options"];
  const Json lamps = read_json(at("lamps/report.json"))["options"];
  EXPECT_EQ(paths["integrator"], "path");
  EXPECT_EQ(paths["diffuse_depth"], 1);
  EXPECT_EQ(paths["glossy_depth"], 2);
  EXPECT_EQ(paths["transmission_depth"], 3);
  for (const char* none : {"tunnels", "groups", "color_trees"}) EXPECT_EQ(paths[none], 0) << none;
  EXPECT_EQ(lamps["integrator"], "whitted");
  EXPECT_TRUE(lamps["diffuse_depth"].is_null());
  EXPECT_GT(lamps["tunnels"], 0);
  EXPECT_EQ(relook({"blame", at("paths"), "1,1", "--quiet"}).exit_code, 0);
}

TEST_F(IntegratorCli, a_cache_or_run_of_the_other_one_is_in_the_way) {
  write_journal();
  ASSERT_EQ(preprocess_path("c").exit_code, 0);
  EXPECT_EQ(preprocess_path("c").exit_code, 0) << "complete";
  expect_error(relook({"preprocess", kScene, "-o", at("c"), "--resolution", "24x16", "--integrator", "whitted"}), 1,
               "--integrator (path)");
  expect_error(preprocess_path("c", {"--glossy-depth", "1"}), 1, "--glossy-depth (4)");
  ASSERT_EQ(replay("c", "r").exit_code, 0);
  ASSERT_EQ(relook({"preprocess", kScene, "-o", at("w"), "--resolution", "24x16", "--integrator", "whitted",
                    "--samples", "64", "--quiet"})
                .exit_code,
            0);
  expect_error(replay("w", "r"), 1, "frames of --integrator path, not whitted");
}

TEST_F(IntegratorCli, inspect_says_how_large_areas_are_and_what_a_cache_is_of) {
  const std::filesystem::path scene = at("lit/spheres.gltf");
  std::filesystem::copy(std::filesystem::path(kScene).parent_path(), at("lit"),
                        std::filesystem::copy_options::recursive);
  Json gltf = read_json(scene);
  gltf["extensionsUsed"].push_back("EXT_lights_area");
  gltf["extensions"]["EXT_lights_area"]["lights"] = {
      {{"name", "Panel"}, {"type", "rect"}, {"size", 2}, {"rect", {{"aspect", 3}}}}};
  gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
  gltf["nodes"].push_back({{"name", "Above"},
                           {"translation", {0, 4, 0}},
                           {"extensions", {{"EXT_lights_area", {{"light", 0}}}}}});
  write_text(scene, gltf.dump());
  const ProgramResult plain = relook({"inspect", scene.string(), "--integrator", "whitted"});
  EXPECT_EQ(plain.exit_code, 0);
  EXPECT_NE(plain.output.find("light Panel: rect, 6 x 2 m"), std::string::npos) << plain.output;
  EXPECT_NE(plain.output.find("only with --integrator path"), std::string::npos) << plain.output;
  const ProgramResult result = relook({"inspect", scene.string(), "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  const Json summary = parse_json(result.output, "stdout");  // and no warning
  ASSERT_EQ(summary["areas"].size(), 1U);
  EXPECT_EQ(summary["areas"][0]["light"], "Panel");
  EXPECT_EQ(summary["areas"][0]["kind"], "rect");
  EXPECT_EQ(summary["areas"][0]["size"], (Json{6.0, 2.0}));
  EXPECT_FALSE(summary.contains("sun_share")) << "the environment has no image";
  ASSERT_EQ(preprocess_path("c").exit_code, 0);
  const ProgramResult cache = relook({"inspect", at("c")});
  EXPECT_NE(cache.output.find("path, depth 6 (diffuse 2, glossy 4, transmission 16)"), std::string::npos)
      << cache.output;
}

}  // namespace
}  // namespace relook
