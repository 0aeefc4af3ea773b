// `relook compare` of frames and runs as scripts see it: exit codes, lines and JSON.
#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"
#include "frame/frame_file.h"
#include "run_program.h"

namespace relook {
namespace {

const char* const kJournal = R"({"relook": "journal/1", "steps": [
  {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                              "value": [0.1, 0.9, 0.1, 1]}]},
  {"name": "up", "edit": [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0, 1.2, 0]}]}]})";

ProgramResult compare(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {RELOOK_PROGRAM, "compare"});
  arguments.insert(arguments.end(), {"--progress", "none"});
  return run_program(arguments);
}

class CompareFrames : public testing::Test {
 protected:
  CompareFrames() {
    write("a.exr", frame_);
    frame_.pixels[5 * 32 + 3].r += 0.25F;
    write("b.exr", frame_);
    write("half.exr", {16, 16, std::vector<Rgba>(256)});
  }
  void write(const std::string& name, const Frame& frame) const {
    write_file(folder_ / name, encode_exr(frame, {}, PixelFormat::float32));
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Json json(const std::string& name) const {
    const Bytes bytes = read_file(folder_ / name);
    return parse_json(text_of(bytes), name);
  }
  ScratchFolder folder_{"compare"};
  Frame frame_{32, 32, std::vector<Rgba>(32 * 32, Rgba(0.5F, 0.25F, 0.125F, 1))};
};

TEST_F(CompareFrames, thresholds_decide_the_exit_code) {
  EXPECT_EQ(compare({at("a.exr"), at("a.exr")}).exit_code, 0);
  EXPECT_EQ(compare({at("a.exr"), at("b.exr")}).exit_code, 10);
  EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--fail", "0.25"}).exit_code, 0);
  EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--failpercent", "0.1"}).exit_code, 0);
  EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--failpercent", "0.09"}).exit_code, 10);
  EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--failpercent", "1", "--hardfail", "0.1"}).exit_code, 10);
  EXPECT_EQ(compare({at("a.exr"), at("half.exr"), "--fail", "1000"}).exit_code, 2) << "sizes never match";
  const ProgramResult warned = compare({at("a.exr"), at("b.exr"), "--fail", "1", "--warn", "0.1"});
  EXPECT_EQ(warned.exit_code, 0);
  EXPECT_NE(warned.output.find("relook: warning: "), std::string::npos) << warned.output;
  for (const std::string value : {"nan", "-1", "inf", "x"})
    EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--fail", value}).exit_code, 1) << value;
  EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--failpercent", "101"}).exit_code, 1);
  EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--exact", "--failflip", "0.1"}).exit_code, 1);
  EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--exact", "--peak", "2"}).exit_code, 1);
  for (const std::string value : {"0", "-1", "nan", "inf"})
    EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--peak", value}).exit_code, 1) << value;
  EXPECT_EQ(compare({at("a.exr")}).exit_code, 1);
}

TEST_F(CompareFrames, results_are_json_on_stdout_or_in_a_file) {
  const Json printed = parse_json(compare({at("a.exr"), at("b.exr"), "--json"}).output, "stdout");
  EXPECT_EQ(printed["relook"], "compare/1");
  EXPECT_EQ(printed["verdict"], "failure");
  EXPECT_EQ(printed["total"]["pixels_different"], 1);
  EXPECT_EQ(printed["frames"]["b.exr"]["worst_pixel"]["x"], 3);
  EXPECT_EQ(printed["frames"]["b.exr"]["worst_pixel"]["y"], 5);
  EXPECT_EQ(printed["frames"]["b.exr"]["max_error"], 0.25);
  EXPECT_GT(printed["frames"]["b.exr"]["flip"]["mean"], 0);
  EXPECT_EQ(compare({"--json", at("one.json"), at("a.exr"), at("b.exr")}).exit_code, 10);
  EXPECT_EQ(compare({at("a.exr"), at("b.exr"), "--json=" + at("two.json")}).exit_code, 10);
  EXPECT_EQ(json("one.json"), printed);
  EXPECT_EQ(json("two.json"), printed);
  const Json exact = parse_json(compare({at("a.exr"), at("b.exr"), "--json", "--exact"}).output, "stdout");
  EXPECT_TRUE(exact["frames"]["b.exr"]["flip"].is_null());
  EXPECT_TRUE(exact["psnr_peak"].is_null());
  EXPECT_EQ(printed["psnr_peak"], 1);
  const Json bright = parse_json(compare({at("a.exr"), at("b.exr"), "--json", "--peak", "100"}).output, "stdout");
  EXPECT_EQ(bright["psnr_peak"], 100);
  EXPECT_NEAR(bright["frames"]["b.exr"]["psnr"].get<double>(), printed["frames"]["b.exr"]["psnr"].get<double>() + 40,
              1e-9);
}

TEST_F(CompareFrames, the_page_is_whole_and_takes_names_as_text) {
  const auto page = [&](const std::string& name) {
    const Bytes bytes = read_file(folder_ / name);
    return std::string(text_of(bytes));
  };
  const std::string hostile = "<img src=x onerror=alert(1)>&\"'.exr";
  std::filesystem::create_directories(folder_ / "one");
  std::filesystem::create_directories(folder_ / "two");
  std::filesystem::copy(at("a.exr"), folder_ / "one" / hostile);
  std::filesystem::copy(at("b.exr"), folder_ / "two" / hostile);
  EXPECT_EQ(compare({at("one"), at("two"), "--html", at("page.html")}).exit_code, 10);
  const std::string text = page("page.html");
  EXPECT_NE(text.find("<meta charset=\"utf-8\">\n<meta name=\"generator\" content=\"relook\">\n"), std::string::npos);
  EXPECT_EQ(text.find("<img src=x"), std::string::npos);
  EXPECT_NE(text.find("&lt;img src=x onerror=alert(1)&gt;&amp;&quot;&#39;.exr"), std::string::npos)
      << text.substr(0, 3000);
  EXPECT_NE(text.find("Content-Security-Policy\" content=\"default-src 'none'"), std::string::npos);
  std::size_t pictures = 0;
  for (std::size_t at = text.find("data:image/png;base64,"); at != std::string::npos;
       at = text.find("data:image/png;base64,", at + 1))
    ++pictures;
  EXPECT_EQ(pictures, 3U) << "both frames and where they differ";
  EXPECT_NE(text.find("3,5: 0.5 0.25 0.125 1 and 0.75 0.25 0.125 1"), std::string::npos);
  EXPECT_TRUE(text.ends_with("</html>\n"));
  EXPECT_EQ(compare({at("a.exr"), at("a.exr"), "-o", at("report")}).exit_code, 0);
  EXPECT_EQ(page("report/compare.html").find("data:image"), std::string::npos) << "no pictures of equal frames";
}

TEST_F(CompareFrames, several_frames_are_compared_with_the_first) {
  const Json result = parse_json(compare({at("a.exr"), at("a.exr"), at("b.exr"), "--json"}).output, "stdout");
  ASSERT_EQ(result["pairs"].size(), 2U);
  EXPECT_EQ(result["relook"], "compare/1");
  EXPECT_EQ(result["pairs"][0]["verdict"], "equal");
  EXPECT_EQ(result["pairs"][1]["verdict"], "failure");
  EXPECT_EQ(result["verdict"], "failure");
}

TEST_F(CompareFrames, a_run_and_a_folder_of_frames_are_compared_by_name) {
  std::filesystem::create_directories(folder_ / "run/frames");
  std::filesystem::create_directories(folder_ / "plain");
  std::filesystem::copy(at("a.exr"), at("run/frames/0000.exr"));
  std::filesystem::copy(at("a.exr"), at("plain/0000.exr"));
  EXPECT_EQ(compare({at("run"), at("plain")}).exit_code, 0);
  std::filesystem::copy(at("b.exr"), at("plain/0001.exr"));
  EXPECT_EQ(compare({at("run"), at("plain"), "--fail", "1000"}).exit_code, 10) << "a missing frame never passes";
  EXPECT_EQ(compare({at("run"), at("a.exr")}).exit_code, 2);
}

TEST_F(CompareFrames, runs_of_other_settings_are_a_table) {
  const auto relook = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), RELOOK_PROGRAM);
    return run_program(arguments).exit_code;
  };
  std::ofstream(folder_ / "j.json") << kJournal;
  ASSERT_EQ(
      relook({"preprocess", kScene, "--integrator", "whitted", "-o", at("c"), "--resolution", "72x40", "--quiet"}), 0);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("one"), "--quiet", "--baseline"}), 0);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("two"), "--quiet", "--tunnels", "0"}), 0);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("three"), "--quiet", "--groups", "0"}), 0);
  const ProgramResult result = compare({at("one"), at("two"), at("three"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Json runs = parse_json(result.output, "stdout")["runs"];
  ASSERT_EQ(runs["columns"].size(), 3U);
  EXPECT_GT(runs["columns"][0]["full_render_seconds"], 0);
  EXPECT_EQ(runs["columns"][0]["settings"], Json::parse(R"({"groups": "4", "tunnels": "1"})"));
  EXPECT_EQ(runs["columns"][1]["settings"]["tunnels"], "0");
  ASSERT_EQ(runs["rows"].size(), 3U);
  EXPECT_EQ(runs["rows"][2]["class"], "geometric");
  EXPECT_EQ(runs["rows"][2]["ray_tests"].size(), 3U);
  EXPECT_LE(runs["rows"][2]["ray_tests"][0], runs["rows"][2]["ray_tests"][1]) << "tunnels cull no less than boxes";
  EXPECT_EQ(runs["rows"][1]["pixels_changed"][0], runs["rows"][1]["pixels_changed"][2]);
  const std::string text = compare({at("one"), at("two"), at("three")}).output;
  EXPECT_NE(text.find("B: " + at("two") + ", groups 4, tunnels 0"), std::string::npos) << text;
  EXPECT_NE(text.find("ray_tests"), std::string::npos) << text;
  std::ofstream(folder_ / "two/report.json") << R"({"relook": "report/1"})";
  EXPECT_EQ(compare({at("one"), at("two")}).exit_code, 2);
}

}  // namespace
}  // namespace relook
