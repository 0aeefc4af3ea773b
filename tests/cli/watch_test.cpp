// `relook watch`: exports by parts, by rename, and broken ones in between, become steps of a journal whose frames are
// those of full renders; a watch that was ended goes on.
#include <signal.h>

#include <chrono>
#include <functional>
#include <thread>

#include "cli_fixture.h"

namespace relook {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class WatchVerb : public Cli {
 protected:
  void SetUp() override {
    scene_ = read_json(kScene);
    const fs::path folder = fs::path(kScene).parent_path();
    fs::create_directory(at("scene"));
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() != ".gltf")
        fs::copy(entry.path(), at("scene/" + entry.path().filename().string()), fs::copy_options::recursive);
    write_scene();
  }

  [[nodiscard]] std::string scene() const { return at("scene/shot.gltf"); }
  void write_scene() const { write_file(scene(), scene_.dump()); }

  [[nodiscard]] Json& material(const std::string& name) {
    for (Json& material : scene_["materials"])
      if (material["name"] == name) return material;
    ADD_FAILURE() << name;
    return scene_["materials"][0];
  }

  [[nodiscard]] std::vector<std::string> command(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"watch", scene(),        "--cache", at("cache"),  "-o",  at("run"), "--resolution",
                                   "48x27", "--integrator", "whitted", "--interval", "0.1", "--float"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// Until it holds; a failure after a minute.
  static void wait_until(const std::string& what, const std::function<bool()>& holds) {
    for (int i = 0; i < 1200 && !holds(); ++i) std::this_thread::sleep_for(50ms);
    EXPECT_TRUE(holds()) << what;
  }
  [[nodiscard]] bool has_reported(std::size_t entries) const {
    if (!fs::exists(at("run/report.json"))) return false;
    const Json report = read_json(at("run/report.json"));
    return report["steps"].size() == entries;
  }
  void wait_for_entries(std::size_t entries) const {
    wait_until(std::to_string(entries) + " entries", [&] { return has_reported(entries); });
  }

  /// Frame `step` of the run is a full render of the scene file as it is.
  void expect_frame(std::uint32_t step) const {
    const std::string frame = at("full.exr"), number = std::to_string(step);
    const ProgramResult rendered = relook(
        {"render", scene(), "-o", frame, "--resolution", "48x27", "--integrator", "whitted", "--float", "--quiet"});
    ASSERT_EQ(rendered.exit_code, 0) << rendered.output;
    const ProgramResult result = relook(
        {"compare", at("run/frames/" + std::string(4 - number.size(), '0') + number + ".exr"), frame, "--exact"});
    EXPECT_EQ(result.exit_code, 0) << result.output;
  }

  Json scene_;
};

TEST_F(WatchVerb, each_sound_export_becomes_a_step_and_a_frame) {
  const pid_t watch = start_relook(command({"--exports", "3"}));
  wait_for_entries(1);
  expect_frame(0);

  material("Paint")["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.8, 0.2, 1.0};
  write_scene();
  wait_for_entries(2);
  expect_frame(1);

  // Broken for a while: half of the text, then another file by rename.
  const std::string text = scene_.dump();
  std::ofstream(scene()) << text.substr(0, text.size() / 2);
  std::this_thread::sleep_for(1s);
  EXPECT_TRUE(has_reported(2));
  material("Paint")["pbrMetallicRoughness"]["roughnessFactor"] = 0.2;
  for (Json& node : scene_["nodes"])
    if (node["name"] == "CentralSphere") node["translation"] = {0.3, 1.0, 0.2};
  write_file(at("scene/next"), scene_.dump());
  fs::rename(at("scene/next"), scene());
  wait_for_entries(3);
  expect_frame(2);

  // A file that it names comes later than the scene.
  fs::create_directory(at("scene/late"));
  const std::size_t image = scene_["images"].size(), texture = scene_["textures"].size();
  scene_["images"].push_back({{"name", "Late"}, {"uri", "late/weave.png"}});
  scene_["textures"].push_back({{"name", "Late"}, {"source", image}});
  material("Paint")["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
  write_scene();
  std::this_thread::sleep_for(1s);
  EXPECT_TRUE(has_reported(3));
  fs::copy_file(fs::path(RELOOK_SOURCE_DIR) / "journals/files/weave.png", at("scene/late/weave.png"));
  wait_for_entries(4);
  expect_frame(3);
  EXPECT_EQ(wait_for(watch), 0);

  const Bytes live = read_file(at("run/relook_live.js"));
  EXPECT_EQ(text_of(live), "relook_live(4, false);\n");
  const Bytes page = read_file(at("run/report.html"));
  EXPECT_NE(text_of(page).find("relook_live.js?"), std::string_view::npos);
  // The journal replays to the same run.
  const ProgramResult result =
      relook({"replay", at("cache"), at("run.json"), "-o", at("again"), "--float", "--verify", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(relook({"compare", at("run"), at("again"), "--exact"}).exit_code, 0);
}

TEST_F(WatchVerb, goes_on_where_a_signal_ended_it) {
  const pid_t first = start_relook(command());
  wait_for_entries(1);
  material("Paint")["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.8, 0.2, 1.0};
  write_scene();
  wait_for_entries(2);
  ::kill(first, SIGTERM);
  EXPECT_EQ(wait_for(first), 128 + SIGTERM);
  material("Paint")["pbrMetallicRoughness"]["metallicFactor"] = 1.0;
  write_scene();  // while nobody looks
  const pid_t second = start_relook(command({"--exports", "2"}));
  wait_for_entries(3);
  expect_frame(2);
  material("Paint")["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.1, 0.2, 1.0};
  write_scene();
  wait_for_entries(4);
  expect_frame(3);
  EXPECT_EQ(wait_for(second), 0);
}

TEST_F(WatchVerb, says_what_no_journal_can_say) {
  ASSERT_EQ(relook(command({"--exports", "0"})).exit_code, 0);
  for (Json& node : scene_["nodes"])
    if (node.contains("camera")) node["translation"] = {0.5, 2.0, 9.0};
  material("Paint")["pbrMetallicRoughness"]["roughnessFactor"] = 0.2;
  write_scene();
  const ProgramResult result = relook(command({"--exports", "1"}));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("the camera is not as in"), std::string::npos) << result.output;
  EXPECT_TRUE(has_reported(2)) << "the rest is a step";
}

}  // namespace
}  // namespace relook
