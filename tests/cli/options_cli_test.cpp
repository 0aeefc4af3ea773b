// Options, grids, notes and wildcards through the program: what a run's report and headers say of them, that each frame
// is `render`'s, and that runs are taken up again within them.
#include <fstream>

#include "frame/frame_file.h"
#include "report/run_folder.h"

namespace relook {
namespace {

class JournalOptions : public RunFolderTest {
 protected:
  static std::vector<Json> option_steps() {
    std::vector<Json> steps = steps_of_journal();
    steps.push_back(
        {{"name", "grid"},
         {"from", "one"},
         {"keep", false},
         {"note", "which of the six?"},
         {"wedge",
          {{{"path", "/materials/P*/pbrMetallicRoughness/roughnessFactor"},
            {"label", "gloss"},
            {"values", {0.125, 0.5}}},
           {{"path", "/materials/Glass/extensions/KHR_materials_ior/ior"}, {"values", {1.25, 1.5, 1.75}}}}}});
    steps.push_back({{"name", "slid"},
                     {"from", "base"},
                     {"select", {"/nodes/CentralSphere"}},
                     {"drag", {move(-0.1), move(-0.2)}},
                     {"keep", false}});
    steps.push_back(color_step("on", 0.25));
    steps.back()["author"] = "Ada";
    steps.back()["extras"] = {{"shot", 7}};
    return steps;
  }
  void SetUp() override {
    RunFolderTest::SetUp();
    std::ofstream(at("j.json"))
        << Json{{"relook", "journal/1"}, {"note", "of all"}, {"author", "Bo"}, {"steps", option_steps()}}.dump();
  }
  [[nodiscard]] Json entry(const Json& report, const std::string& frame) const {
    for (const Json& step : report["steps"])
      if (step["frame"] == frame) return step;
    return nullptr;
  }
};

TEST_F(JournalOptions, every_frame_is_that_of_a_full_render_and_the_report_says_what_it_is) {
  ASSERT_EQ(replay("run", {"--verify"}).exit_code, 0);
  const Json all = report("run");
  EXPECT_EQ(all["journal"]["note"], "of all");
  const Json cell = entry(all, "frames/0006_05.exr");
  ASSERT_TRUE(cell.is_object());
  EXPECT_EQ(cell["from"], 1);
  EXPECT_EQ(cell["keep"], false);
  EXPECT_EQ(cell["note"], "which of the six?");
  EXPECT_EQ(cell["values"][0]["text"], "0.5");
  EXPECT_EQ(cell["values"][0]["label"], "gloss");
  EXPECT_EQ(cell["values"][1]["value"], 1.5);
  EXPECT_EQ(cell["full_render"]["measured"], true);
  EXPECT_GT(cell["full_render"]["rays"], 0);
  EXPECT_GT(cell["seconds"]["cpu"], 0);
  for (const Json& step : all["steps"])
    if (step["step"] == 6 && step["wedge_frame"].is_null()) {
      EXPECT_EQ(step["axes"][1]["texts"], Json({"1.25", "1.5", "1.75"}));
    }
  const Json last = entry(all, "frames/0008.exr");
  EXPECT_EQ(last["from"], 0);  // what came before was put back
  EXPECT_EQ(last["class"], "color");
  EXPECT_EQ(last["extras"]["shot"], 7);
}

TEST_F(JournalOptions, headers_carry_the_words_of_the_journal) {
  ASSERT_EQ(replay("run").exit_code, 0);
  const std::optional<FrameMeta> cell = own_frame_meta(at("run/frames/0006_05.exr"));
  ASSERT_TRUE(cell.has_value());
  EXPECT_EQ(cell->name, "grid");
  EXPECT_EQ(cell->note, "which of the six?");
  EXPECT_EQ(cell->author, "Bo");
  EXPECT_EQ(Json::parse(cell->edit)[1]["value"], 1.5);
  EXPECT_EQ(Json::parse(cell->values)[0]["text"], "0.5");
  const std::optional<FrameMeta> last = own_frame_meta(at("run/frames/0008.exr"));
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->author, "Ada");
  EXPECT_EQ(Json::parse(last->extras)["shot"], 7);
  EXPECT_EQ(last->values, "");
}

TEST_F(JournalOptions, render_writes_the_bytes_of_the_last_frame_of_each_step) {
  for (const bool layers : {false, true}) {
    const std::string run = layers ? "layers" : "run";
    ASSERT_EQ(replay(run, layers ? std::vector<std::string>{"--aovs"} : std::vector<std::string>{}).exit_code, 0);
    const Json all = report(run);
    for (const Json& step : all["steps"]) {
      if (step["step"] < 5 || !step["wedge_frame"].is_null() || !step["drag_frame"].is_null()) continue;
      std::vector<std::string> arguments{
          "render",       kScene,  "--integrator", "whitted",    "-o",     at("f.exr"),
          "--resolution", "72x40", "--journal",    at("j.json"), "--step", std::to_string(step["step"].get<int>()),
          "--overwrite"};
      if (layers) arguments.push_back("--aovs");
      ASSERT_EQ(relook(arguments).exit_code, 0);
      EXPECT_EQ(hash128(read_file(at("f.exr"))), step["frame_hash"]) << step["name"] << run;
    }
  }
}

TEST_F(JournalOptions, runs_add_up_in_any_order_of_steps) {
  ASSERT_EQ(replay("whole").exit_code, 0);
  for (const char* steps : {"8", "6", "0-2", "7", "3-5"})
    ASSERT_EQ(replay("run", {"--steps", steps}).exit_code, 0) << steps;
  expect_same_run("run", "whole");
  std::filesystem::remove(at("run/frames/0006_03.exr"));
  std::filesystem::remove(at("run/frames/0007_02.exr"));
  ASSERT_EQ(replay("run").exit_code, 0);
  expect_same_run("run", "whole");
  EXPECT_EQ(report("run")["resumed"]["frames"], report("run")["frames"].size() - 2);
}

TEST_F(JournalOptions, inspect_plan_and_blame_tell_the_tree) {
  const ProgramResult inspected = relook({"inspect", at("j.json"), "--scene", at("c")});
  EXPECT_NE(inspected.output.find("6.5 \"grid\" 0.5 1.5"), std::string::npos) << inspected.output;
  EXPECT_NE(inspected.output.find("from 1 \"one\""), std::string::npos) << inspected.output;
  EXPECT_NE(inspected.output.find("8 \"on\" from base: color"), std::string::npos) << inspected.output;
  const ProgramResult planned = relook({"plan", at("c"), at("j.json"), "--json", "--progress", "none"});
  ASSERT_EQ(planned.exit_code, 0) << planned.output;
  EXPECT_NE(planned.output.find("\"from\""), std::string::npos) << planned.output.substr(0, 2000);
  const std::string lines = relook({"plan", at("c"), at("j.json"), "--progress", "none"}).output;
  EXPECT_NE(lines.find("6_05 "), std::string::npos) << lines;
  EXPECT_NE(lines.find("\"grid\" 0.5 1.5:"), std::string::npos) << lines;
  EXPECT_NE(lines.find("\"on\" from base:"), std::string::npos) << lines;
  ASSERT_EQ(replay("run").exit_code, 0);
  const ProgramResult blamed = relook({"blame", at("run"), "36,20"});
  EXPECT_EQ(blamed.exit_code, 0) << blamed.output;
}

}  // namespace
}  // namespace relook
