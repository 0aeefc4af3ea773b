// `relook report`: pages made anew, indexes over several runs, and one file that holds everything; what none of them
// replaces.
#include <gtest/gtest.h>

#include "report/own_file.h"
#include "run_folder.h"

namespace relook {
namespace {

class ReportVerb : public RunFolderTest {
 protected:
  [[nodiscard]] std::string text(const std::string& name) const {
    const Bytes bytes = read_file(at(name));
    return std::string(text_of(bytes));
  }
  [[nodiscard]] bool has(const std::string& name, const std::string& part) const {
    return text(name).find(part) != std::string::npos;
  }
  void replay_two() {
    write_journal("k.json", {color_step("other", 0.5)});
    const ProgramResult result =
        relook({"replay", at("c"), at("j.json"), at("k.json"), "-o", at("runs"), "--progress", "none", "--verify"});
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
};

TEST_F(ReportVerb, a_page_is_made_anew_from_the_run_alone) {
  ASSERT_EQ(replay("run").exit_code, 0);
  const std::string before = text("run/report.html");
  for (const char* gone : {"run/report.html", "j.json"}) std::filesystem::remove(at(gone));
  const auto frames = pictures("run");
  const ProgramResult result = relook({"report", at("run")});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(is_own_file(at("run/report.html"), OwnKind::page));
  EXPECT_TRUE(has("run/report.html", "baseColorFactor")) << "edits are in the headers of the frames";
  EXPECT_NEAR(static_cast<double>(text("run/report.html").size()), static_cast<double>(before.size()), 3000);
  EXPECT_EQ(pictures("run"), frames);
}

TEST_F(ReportVerb, several_journals_get_an_index) {
  replay_two();
  const std::string index = text("runs/index.html");
  EXPECT_TRUE(is_own_file(at("runs/index.html"), OwnKind::page));
  for (const char* part :
       {"href=\"j/report.html\"", "href=\"k/report.html\"", "5 steps", "1 step", "verified: all", "j/report.json"})
    EXPECT_NE(index.find(part), std::string::npos) << part;
  std::filesystem::remove(at("runs/index.html"));
  ASSERT_EQ(relook({"report", at("runs")}).exit_code, 0);
  EXPECT_EQ(text("runs/index.html"), index);
  // The same command goes on in this folder, index and all.
  const ProgramResult again =
      relook({"replay", at("c"), at("j.json"), at("k.json"), "-o", at("runs"), "--progress", "none"});
  EXPECT_EQ(again.exit_code, 0) << again.output;
}

TEST_F(ReportVerb, an_index_links_runs_anywhere) {
  replay_two();
  ASSERT_EQ(replay("a b%/run").exit_code, 0);
  std::filesystem::create_directories(at("web"));
  const ProgramResult result = relook({"report", at("a b%/run"), at("runs/k"), "-o", at("web/index.html")});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(has("web/index.html", "href=\"../a%20b%25/run/report.html\""));
  EXPECT_TRUE(has("web/index.html", "href=\"../runs/k/report.html\""));
}

TEST_F(ReportVerb, a_foreign_index_is_never_replaced) {
  write_text("runs/index.html", "mine");
  write_journal("k.json", {color_step("other", 0.5)});
  expect_refused("runs", {"index.html"}, [&] {
    return relook({"replay", at("c"), at("j.json"), at("k.json"), "-o", at("runs"), "--progress", "none"});
  });
}

TEST_F(ReportVerb, one_file_holds_all_and_says_what_it_takes) {
  ASSERT_EQ(replay("run").exit_code, 0);
  const ProgramResult result = relook({"report", at("run"), "--single-file", "-o", at("one.html"), "--scale", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  for (const char* part : {"previews ", "pixels ", "data ", "viewer ", " in all"})
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
  EXPECT_TRUE(has("one.html", "\"width\":36")) << "half of 72";
  EXPECT_TRUE(has("one.html", "\"single\":{"));
  EXPECT_FALSE(std::filesystem::exists(at("run/pixels")));
  const ProgramResult as_json =
      relook({"report", at("run"), "--single-file", "-o", at("one.html"), "--json", "--quiet"});
  const Json sizes = parse_json(as_json.output, "--json");
  EXPECT_EQ(sizes["bytes"]["total"], std::filesystem::file_size(at("one.html")));
  EXPECT_EQ(sizes["scale"], 1);
}

TEST_F(ReportVerb, previews_stand_for_frames_that_are_missing) {
  ASSERT_EQ(replay("run").exit_code, 0);
  std::filesystem::remove(at("run/frames/0003.exr"));
  write_text("run/frames/0001.exr", "damaged");
  const ProgramResult result =
      relook({"report", at("run"), "--single-file", "-o", at("one.html"), "--json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(parse_json(result.output, "--json")["previews_alone"], 2);
}

TEST_F(ReportVerb, several_runs_go_into_one_file) {
  replay_two();
  const ProgramResult result = relook({"report", at("runs"), "--single-file", "-o", at("all.html"), "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  for (const char* part : {"href=\"?run=1\"", "href=\"?run=2\"", "id=\"pixels-2\"", "data-runs=\"2\""})
    EXPECT_TRUE(has("all.html", part)) << part;
}

TEST_F(ReportVerb, pages_that_are_sent_in_a_browser) {
  replay_two();
  ASSERT_EQ(replay("other", {}, "k.json").exit_code, 0);
  for (const std::vector<std::string>& page :
       {std::vector<std::string>{"report", at("runs/j"), "--single-file", "--scale", "2", "-o", at("one.html")},
        {"report", at("runs"), "--single-file", "-o", at("all.html")}})
    ASSERT_EQ(relook(page).exit_code, 0);
  std::filesystem::create_directories(at("base"));
  for (const char* name : {"0001.exr", "0003.exr", "0005.exr"})
    std::filesystem::copy_file(at("runs/j/frames/0000.exr"), at("base/") + name);
  EXPECT_EQ(relook({"compare", at("base"), at("runs/j"), "--html", at("compare.html")}).exit_code, 10);
  const std::string script = std::string(RELOOK_SOURCE_DIR) + "/tests/pages/sent_page.py";
  const ProgramResult result = run_program({"python3", script, at(""), at("")});
  if (result.exit_code == 77) GTEST_SKIP() << "no chromium and chromedriver: pages that are sent are NOT tested";
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(ReportVerb, nothing_foreign_is_replaced) {
  ASSERT_EQ(replay("run").exit_code, 0);
  write_text("mine.html", "mine");
  expect_refused("", {"--overwrite"}, [&] {
    return relook({"report", at("run"), "--single-file", "-o", at("mine.html")});
  });
  expect_refused("", {"is part of the run"}, [&] {
    return relook({"report", at("run"), "--single-file", "-o", at("run/report.html")});
  });
  expect_refused("", {"-o"}, [&] { return relook({"report", at("run"), "--single-file"}); });
  expect_refused("", {"--single-file"}, [&] {
    return relook({"report", at("run"), "-o", at("i.html"), "--scale", "2"});
  });
  EXPECT_EQ(relook({"report", at("c")}).exit_code, 2);
  EXPECT_EQ(relook({"report", at("nowhere")}).exit_code, 2);
}

}  // namespace
}  // namespace relook
