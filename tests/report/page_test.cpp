// report.html as a browser shows it (tests/pages), and as a file: its policy, what stands in it, its size.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "base/files.h"
#include "page_browser.h"
#include "run_program.h"

namespace relook {
namespace {

const std::filesystem::path kSourceRoot = RELOOK_SOURCE_DIR;
const std::filesystem::path kAssets = kSourceRoot / ".." / "shared" / "assets";

void write_text(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

void run_relook(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), RELOOK_PROGRAM);
  const ProgramResult result = run_program(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.output;
}

TEST(Page, table1_on_spheres_in_a_browser) {
  const ScratchFolder folder("page_table1");
  run_relook({"preprocess", (kSourceRoot / "scenes/spheres/spheres.gltf").string(), "--integrator", "whitted", "-o",
              (folder / "cache").string(), "--resolution", "480x270", "--quiet"});
  run_relook({"replay", (folder / "cache").string(), (kSourceRoot / "journals/table1.json").string(), "-o",
              (folder / "run").string(), "--overlays", "--baseline", "--quiet"});
  use_in_browser("report_page.py", folder / "run", page_expectations(folder / "run", true), folder);
}

TEST(Page, options_and_grids_of_spheres_in_a_browser) {
  const ScratchFolder folder("page_options");
  const auto color = [](double red) {
    return Json::array({{{"op", "replace"},
                         {"path", "/materials/Paint/pbrMetallicRoughness/baseColorFactor"},
                         {"value", {red, 0.2, 0.1, 1}}}});
  };
  const Json red{{"path", "/materials/Paint/pbrMetallicRoughness/baseColorFactor/0"}, {"values", {0.1, 0.9}}};
  const Json green{{"path", "/materials/Paint/pbrMetallicRoughness/baseColorFactor/1"},
                   {"label", "green"},
                   {"range", {{"from", 0.1}, {"to", 0.7}, {"count", 3}}}};
  const Json steps{{{"name", "red"}, {"edit", color(0.9)}, {"note", "a first guess"}},
                   {{"name", "dark"}, {"from", "base"}, {"edit", color(0.05)}, {"author", "Ana"}},
                   {{"name", "how red?"}, {"keep", false}, {"wedge", red}},
                   {{"name", "which?"}, {"from", "red"}, {"wedge", Json::array({red, green})}},
                   {{"name", "last"}, {"from", 1}, {"edit", color(0.4)}}};
  write_text(folder / "options.json", Json{{"relook", "journal/1"}, {"note", "Which red?"}, {"steps", steps}}.dump());
  run_relook({"preprocess", (kSourceRoot / "scenes/spheres/spheres.gltf").string(), "--integrator", "whitted", "-o",
              (folder / "cache").string(), "--resolution", "160x90", "--quiet"});
  run_relook({"replay", (folder / "cache").string(), (folder / "options.json").string(), "-o",
              (folder / "run").string(), "--quiet"});
  const Bytes bytes = read_file(folder / "run/report.html");
  const std::string page(text_of(bytes));
  for (const char* part : {R"("axes":[{"count":2,"label":)", R"("label":"green")", R"("note":"a first guess")",
                           R"("author":"Ana")", R"("keep":false)", R"("from":0)", R"("note":"Which red?")"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  use_in_browser("report_page.py", folder / "run", page_expectations(folder / "run", false), folder);
}

TEST(Page, table3_on_garden_in_a_browser) {
  const ScratchFolder folder("page_table3");
  const ProgramResult made = run_program(
      {"python3", (kSourceRoot / "scenes/generate.py").string(), "garden", (folder / "garden").string(), "1"});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  run_relook({"preprocess", (folder / "garden/garden.gltf").string(), "--integrator", "whitted", "-o",
              (folder / "cache").string(), "--resolution", "256x256", "--quiet"});
  run_relook({"replay", (folder / "cache").string(), (kSourceRoot / "journals/table3.json").string(), "-o",
              (folder / "run").string(), "--overlays", "--quiet"});
  use_in_browser("report_page.py", folder / "run", page_expectations(folder / "run", true), folder);
}

TEST(Page, two_hundred_steps_on_toycar_in_a_browser) {
  if (!std::filesystem::exists(kAssets)) GTEST_SKIP() << "no ../shared/assets: a page of 200 steps is NOT tested";
  const ScratchFolder folder("page_toycar");
  Json steps = Json::array();
  for (int i = 0; i < 200; ++i) {
    const double t = (i * 37 % 100) * 0.01;
    Json edit = Json::array();
    if (i % 2 == 0)
      edit.push_back({{"op", "replace"}, {"path", "/nodes/ToyCar/translation"}, {"value", {0.01 * (t + 0.05), 0, 0}}});
    else
      edit.push_back({{"op", "replace"},
                      {"path", "/materials/Fabric/pbrMetallicRoughness/baseColorFactor"},
                      {"value", {t, 1 - t, 0.5, 1}}});
    steps.push_back({{"name", "step " + std::to_string(i + 1)}, {"edit", edit}});
  }
  write_text(folder / "long.json", Json{{"relook", "journal/1"}, {"steps", steps}}.dump());
  run_relook({"preprocess", (kAssets / "toycar/ToyCar.gltf").string(), "--integrator", "whitted", "-o",
              (folder / "cache").string(), "--resolution", "480x270", "--camera", "auto", "--lights", "auto",
              "--quiet"});
  run_relook({"replay", (folder / "cache").string(), (folder / "long.json").string(), "-o", (folder / "run").string(),
              "--quiet"});
  EXPECT_LT(std::filesystem::file_size(folder / "run/report.html"), 5'000'000U);
  use_in_browser("report_page.py", folder / "run", page_expectations(folder / "run", false), folder);
}

class HostilePage : public testing::Test {
 protected:
  /// A run of the spheres with a material, a node and steps of hostile names.
  void SetUp() override {
    const std::string name = "</script><b>x</b><img src=x onerror='window.pwned=1'>&amp;\"";
    const Bytes bytes = read_file(kSourceRoot / "scenes/spheres/spheres.gltf");
    Json scene = parse_json(text_of(bytes), "spheres.gltf");
    for (Json& material : scene["materials"])
      if (material["name"] == "Paint") material["name"] = name;
    std::filesystem::copy(kSourceRoot / "scenes/spheres", folder_ / "spheres",
                          std::filesystem::copy_options::recursive);
    write_text(folder_ / "spheres/spheres.gltf", scene.dump());
    std::string token = name;
    for (std::size_t at = 0; (at = token.find('/', at)) != std::string::npos; at += 2) token.replace(at, 1, "~1");
    const auto step = [&](double red) {
      return Json{{"name", name},
                  {"edit",
                   {{{"op", "replace"},
                     {"path", "/materials/" + token + "/pbrMetallicRoughness/baseColorFactor"},
                     {"value", {red, 0.2, 0.1, 1}}}}}};
    };
    write_text(folder_ / "j.json", Json{{"relook", "journal/1"}, {"steps", {step(0.9), step(0.1), step(0.5)}}}.dump());
    run_relook({"preprocess", (folder_ / "spheres/spheres.gltf").string(), "--integrator", "whitted", "-o",
                (folder_ / "cache").string(), "--resolution", "160x90", "--quiet"});
    run_relook({"replay", (folder_ / "cache").string(), (folder_ / "j.json").string(), "-o", (folder_ / "run").string(),
                "--quiet"});
    const Bytes page = read_file(folder_ / "run/report.html");
    page_ = std::string(text_of(page));
  }
  ScratchFolder folder_{"page_hostile"};
  std::string page_;
};

TEST_F(HostilePage, names_stay_text_in_a_browser) {
  use_in_browser("report_page.py", folder_ / "run", page_expectations(folder_ / "run", false), folder_);
}

TEST_F(HostilePage, nothing_in_the_file_is_remote_or_ends_a_script_early) {
  EXPECT_NE(page_.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
  EXPECT_EQ(page_.find("unsafe-"), std::string::npos);
  EXPECT_EQ(page_.find("<b>x"), std::string::npos);
  EXPECT_EQ(page_.find("<img src=x"), std::string::npos);
  const std::regex remote(R"re((src|href)\s*=\s*["']?(https?:)?//)re");
  EXPECT_FALSE(std::regex_search(page_, remote));
}

}  // namespace
}  // namespace relook
