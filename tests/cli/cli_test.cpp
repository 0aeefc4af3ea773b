// The program as scripts see it: exit codes, one-line messages, JSON on stdout, folders that are not overwritten.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli_fixture.h"

namespace relook {
namespace {

TEST_F(Cli, usage_errors_are_one_line_and_exit_1) {
  expect_error(relook({}), 1, "a verb is required");
  expect_error(relook({"pln"}), 1, "no verb \"pln\"");
  expect_error(relook({"rendr", kScene}), 1, "did you mean \"render\"?");
  expect_error(relook({"render"}), 1, "SCENE");
  expect_error(relook({"render", kScene}), 1, "--output");
  expect_error(relook({"replay", at("c"), "-o", at("r")}), 1, "JOURNAL");
  const auto render_with = [&](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"render", kScene, "-o", at("x.exr")});
    return relook(flags);
  };
  expect_error(render_with({"--resolution", "12"}), 1, "--resolution: \"12\"");
  expect_error(render_with({"--resolution", "0x5"}), 1, "--resolution: \"0x5\"");
  expect_error(render_with({"--resolution", "16385x5"}), 1, "--resolution");
  expect_error(render_with({"--samples", "0"}), 1, "--samples");
  expect_error(render_with({"--samples", "4097"}), 1, "--samples");
  expect_error(render_with({"--max-depth", "17"}), 1, "--max-depth");
  expect_error(render_with({"--threads", "1025"}), 1, "--threads");
  expect_error(render_with({"--threads", "-1"}), 1, "--threads");
  expect_error(render_with({"--lights", "manual"}), 1, "--lights");
  expect_error(render_with({"--progress", "fancy"}), 1, "--progress");
  expect_error(render_with({"--bogus"}), 1, "--bogus");
  expect_error(render_with({"--step", "2"}), 1, "--journal");
  expect_error(relook({"replay", at("c"), at("j"), "-o", at("r"), "--memory", "2X"}), 1, "--memory: \"2X\"");
  expect_error(relook({"preprocess", kScene, "-o", at("c"), "--ray-trees", "101"}), 1, "--ray-trees");
  expect_error(relook({"replay", at("c"), at("j"), "-o", at("r"), "--verify=0"}), 1, "--verify");
  EXPECT_FALSE(std::filesystem::exists(at("x.exr")));
}

TEST_F(Cli, help_and_version_go_to_stdout_and_exit_0) {
  EXPECT_EQ(relook({"--help"}).exit_code, 0);
  EXPECT_EQ(relook({"replay", "--help"}).exit_code, 0);
  EXPECT_TRUE(relook({"--version"}).output.starts_with("relook 0.1.0\narithmetic "));
}

TEST_F(Cli, bad_inputs_exit_2) {
  expect_error(relook({"render", at("none.gltf"), "-o", at("x.exr")}), 2, "none.gltf: ");
  expect_error(relook({"render", kScene, "-o", at("x.exr"), "--camera", "Nope"}), 2, "no camera \"Nope\"");
  write_text(at("bad.json"), R"({"relook": "journal/1", "steps": [{"name": "x", "edit": [], "drags": []}]})");
  ASSERT_EQ(preprocess("c").exit_code, 0);
  expect_error(relook({"replay", at("c"), at("bad.json"), "-o", at("run")}), 2, "/steps/0");
  EXPECT_FALSE(std::filesystem::exists(at("run"))) << "a rejected journal writes nothing";
  expect_error(relook({"compare", at("c"), kScene}), 2, "not a run");
  expect_error(relook({"inspect", at("nothing.glb")}), 2, "no such file");
}

TEST_F(Cli, a_scene_without_camera_or_light_names_the_flag) {
  const std::string geometry = R"("nodes":[{"name":"N"}],"scenes":[{"nodes":[0]}])";
  write_text(at("bare.gltf"), R"({"asset":{"version":"2.0"},)" + geometry + "}");
  expect_error(relook({"render", at("bare.gltf"), "-o", at("x.exr")}), 2, "--camera auto");
  expect_error(relook({"render", at("bare.gltf"), "-o", at("x.exr"), "--camera", "0,0,5:0,0,0:40"}), 2,
               "--lights auto");
}

TEST_F(Cli, compare_finds_differences_and_exits_10) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  const ProgramResult result = relook(
      {"compare", at("run/frames/0000.exr"), at("run/frames/0001.exr"), "-o", at("difference"), "--progress", "none"});
  EXPECT_EQ(result.exit_code, 10);
  EXPECT_GT(read_json(at("difference/compare.json"))["total"]["pixels_different"], 0);
  std::filesystem::copy(at("run"), at("copy"), std::filesystem::copy_options::recursive);
  std::filesystem::remove(at("copy/frames/0002_02.exr"));
  EXPECT_EQ(relook({"compare", at("run"), at("copy"), "--quiet"}).exit_code, 10);
}

TEST_F(Cli, inspect_knows_scene_cache_journal_and_run) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(parse_json(relook({"inspect", kScene, "--json"}).output, "")["lights"], 1);
  EXPECT_EQ(parse_json(relook({"inspect", at("c"), "--json"}).output, "")["relook"], "cache/6");
  EXPECT_EQ(parse_json(relook({"inspect", at("run"), "--json"}).output, "")["relook"], "report/1");
  const Json steps = parse_json(relook({"inspect", at("j.json"), "--scene", kScene, "--json"}).output, "")["steps"];
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0]["class"], "color");
  EXPECT_EQ(steps[2]["class"], "geometric");
  EXPECT_FALSE(steps[0]["reasons"].empty());
  EXPECT_TRUE(parse_json(relook({"inspect", kScene, "--look"}).output, "").contains("materials"));
  EXPECT_TRUE(parse_json(relook({"inspect", at("c"), "--look"}).output, "").contains("materials"));
}

TEST_F(Cli, a_cache_that_does_not_fit_is_refused_with_its_own_code_and_sentence) {
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  const auto replay = [&](std::vector<std::string> flags = {}) {
    flags.insert(flags.begin(), {"replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"});
    return relook(flags);
  };
  EXPECT_EQ(replay({"--scene", kScene}).exit_code, 0);
  expect_error(replay({"--scene", kScene, "--lights", "auto"}), 3, "another scene");
  expect_error(relook({"replay", at("none"), at("j.json"), "-o", at("run")}), 2, "there is no cache here");
  const std::filesystem::path look = at("c/look.json");
  const auto size = std::filesystem::file_size(look);
  std::filesystem::resize_file(look, size - 1);
  expect_error(replay(), 5, "cut short");
  expect_error(relook({"check", at("c"), "--quiet"}), 5, "cut short");
  std::filesystem::resize_file(look, size);
  expect_error(replay(), 5, "damaged");
}

TEST_F(Cli, preprocess_writes_to_a_bare_name_in_the_working_folder) {
  const ProgramResult result =
      run_program({"sh", "-c", "cd \"$0\" && exec \"$1\" preprocess \"$2\" -o bare --quiet --resolution 8x8", at(""),
                   RELOOK_PROGRAM, kScene});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(relook({"check", at("bare"), "--quiet"}).exit_code, 0);
}

TEST_F(Cli, preprocess_finds_out_that_it_cannot_write_before_it_renders) {
  write_text(at("file"), "x");
  expect_error(relook({"preprocess", kScene, "-o", at("file/c"), "--resolution", "8x8", "--progress", "plain"}), 6,
               at("file"));
}

TEST_F(Cli, inspect_shows_and_counts_the_lights_of_lights_auto) {
  const auto inspect = [](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"inspect", kScene});
    return parse_json(relook(flags).output, "stdout");
  };
  const Json look = inspect({"--look", "--lights", "auto"});
  for (const char* light : {"key", "fill", "rim"}) EXPECT_TRUE(look["lights"].contains(light)) << light;
  EXPECT_EQ(inspect({"--lights", "auto", "--json"})["lights"], 4);
  EXPECT_EQ(inspect({"--json"})["lights"], 1);
  ASSERT_EQ(preprocess("c").exit_code, 0);
  expect_error(relook({"inspect", at("c"), "--look", "--lights", "auto"}), 1, "--lights");
}

TEST_F(Cli, replay_does_not_ignore_look_or_lights_without_scene) {
  expect_error(relook({"replay", at("c"), at("j"), "-o", at("r"), "--look", at("patch.json")}), 1, "--scene");
  expect_error(relook({"replay", at("c"), at("j"), "-o", at("r"), "--lights", "auto"}), 1, "--scene");
}

TEST_F(Cli, one_of_several_cameras_is_chosen_with_a_warning) {
  const std::filesystem::path scene = at("two/spheres.gltf");
  std::filesystem::copy(std::filesystem::path(kScene).parent_path(), at("two"),
                        std::filesystem::copy_options::recursive);
  Json gltf = read_json(scene);
  gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
  gltf["nodes"].push_back({{"name", "Second"}, {"camera", 0}, {"translation", {0, 1, 9}}});
  write_text(scene, gltf.dump());
  const auto render = [&](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"render", scene.string(), "-o", at("x.exr"), "--resolution", "8x8"});
    const ProgramResult result = relook(flags);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return result.output;
  };
  const std::string warned = render({"--json", "--progress", "none"});
  ASSERT_NE(warned.find('{'), std::string::npos) << warned;
  const std::string name = parse_json(warned.substr(warned.find('{')), "stdout")["camera"];
  EXPECT_TRUE(warned.starts_with("relook: warning: ")) << warned;
  const std::string line = warned.substr(0, warned.find('\n'));
  EXPECT_NE(line.find("\"" + name + "\""), std::string::npos) << line;
  EXPECT_NE(line.find("--camera"), std::string::npos) << line;
  EXPECT_EQ(render({"--quiet"}), "");
  EXPECT_EQ(render({"--camera", "Second", "--progress", "none"}).find("warning"), std::string::npos);
}

TEST_F(Cli, folders_of_the_user_are_not_overwritten) {
  std::filesystem::create_directory(at("mine"));
  write_text(at("mine/thesis.txt"), "x");
  expect_error(preprocess("mine"), 1, "holds thesis.txt, which relook did not write");
  ASSERT_EQ(preprocess("c").exit_code, 0);
  write_text(at("j.json"), kJournal);
  expect_error(relook({"replay", at("c"), at("j.json"), "-o", at("mine")}), 1, "thesis.txt");
  EXPECT_TRUE(std::filesystem::exists(at("mine/thesis.txt")));
}

}  // namespace
}  // namespace relook
