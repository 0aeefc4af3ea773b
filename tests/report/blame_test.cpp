// `relook blame`: a pixel's history has the colours of the frames, bit for bit, and names a cause exactly where an edit
// changed it.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include "cache/cache.h"
#include "edit/journal_walk.h"
#include "image/render.h"
#include "replay/replay.h"
#include "report/pixel_history.h"
#include "run_program.h"
#include "scene/gltf/import.h"

namespace relook {
namespace {

const std::filesystem::path kProject = RELOOK_SOURCE_DIR;
const std::string kSpheres = (kProject / "scenes/spheres/spheres.gltf").string();
constexpr std::uint32_t kWidth = 96, kHeight = 54;

SceneState spheres(Integrator integrator) {
  LookDocument document = make_look_document(import_gltf(kSpheres));
  const Camera camera = choose_camera(document, "", kWidth, kHeight);
  return {std::move(document), camera, std::make_shared<PyramidStore>(), integrator};
}

bool same_bits(const Rgba& a, const Rgba& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// The frame before a journal and after each of its edits.
std::vector<std::vector<Rgba>> frames_of_replay(const Journal& journal, const ViewOptions& view) {
  SceneState state = spheres(view.integrator);
  RenderStats stats;
  Image image = preprocess(state.scene(), view, stats);
  Replayer replayer(std::move(state), std::move(image));
  std::vector<std::vector<Rgba>> frames{replayer.image().frame.pixels};
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    (void)replayer.step(event.edit(), journal.file, journal.path.parent_path());
    frames.push_back(replayer.image().frame.pixels);
  });
  return frames;
}

/// Of every edit a few pixels that it changed, from all over the image.
std::set<std::size_t> changed_pixels(const std::vector<std::vector<Rgba>>& frames, std::size_t each) {
  std::set<std::size_t> chosen;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    std::vector<std::size_t> changed;
    for (std::size_t i = 0; i < frames[k].size(); ++i)
      if (!same_bits(frames[k - 1][i], frames[k][i])) changed.push_back(i);
    for (std::size_t n = 0; n < each && !changed.empty(); ++n) chosen.insert(changed[changed.size() * n / each]);
  }
  return chosen;
}

void expect_history(const Journal& journal, const ViewOptions& view, std::size_t each) {
  const auto frames = frames_of_replay(journal, view);
  const std::set<std::size_t> pixels = changed_pixels(frames, each);
  ASSERT_FALSE(pixels.empty());
  for (const std::size_t pixel : pixels) {
    const auto x = static_cast<std::uint32_t>(pixel % kWidth), y = static_cast<std::uint32_t>(pixel / kWidth);
    SCOPED_TRACE("pixel " + std::to_string(x) + "," + std::to_string(y));
    PixelHistory history(spheres(view.integrator), view, x, y);
    EXPECT_TRUE(same_bits(history.color(), frames[0][pixel]));
    std::size_t k = 0;
    follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
      ++k;
      const Edit edit = event.edit();
      const PixelStep result = history.step(scene_edit(edit, journal.file, journal.path.parent_path()));
      EXPECT_TRUE(same_bits(result.after, frames[k][pixel])) << event.step->name;
      EXPECT_EQ(result.is_changed, !same_bits(frames[k - 1][pixel], frames[k][pixel])) << event.step->name;
      EXPECT_EQ(result.causes.empty(), !result.is_changed) << event.step->name;
    });
  }
}

TEST(Blame, every_row_of_table1_has_causes_where_it_changed_a_pixel) {
  expect_history(read_journal(kProject / "journals/table1.json"), {}, 2);
}

TEST(Blame, pixels_of_several_samples_are_the_frames_too) {
  expect_history(read_journal(kProject / "journals/table1.json"), {.samples = 4, .max_depth = 4, .shadow_bits = 2}, 1);
}

TEST(Blame, pixels_of_paths_are_the_frames_too) {
  ViewOptions view{.samples = 8, .max_depth = 4, .integrator = Integrator::path};
  view.diffuse_depth = 1;
  expect_history(read_journal(kProject / "journals/table1.json"), view, 1);
}

const char* const kJournal = R"({"relook": "journal/1", "steps": [
  {"name": "green", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                              "value": [0.1, 0.9, 0.1, 1]}]},
  {"name": "slide", "select": ["/nodes/SmallSphere"], "drag": [
    [{"op": "replace", "path": "/nodes/SmallSphere/translation", "value": [2, 0.3, 2.5]}],
    [{"op": "replace", "path": "/nodes/SmallSphere/translation", "value": [-1, 0.3, 3]}]]},
  {"name": "turn", "edit": [{"op": "replace", "path": "/nodes/Cube/translation", "value": [-0.4, 0.1, 1.5]}]},
  {"name": "dim", "edit": [{"op": "replace", "path": "/lights/Lamp/intensity", "value": 90}]}]})";

/// All causes that the steps have at pixels which they changed.
std::set<std::string> all_causes(const Journal& journal) {
  std::set<std::string> causes;
  for (const std::size_t pixel : changed_pixels(frames_of_replay(journal, {}), 12)) {
    PixelHistory history(spheres(Integrator::whitted), {}, static_cast<std::uint32_t>(pixel % kWidth),
                         static_cast<std::uint32_t>(pixel / kWidth));
    follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
      const Edit edit = event.edit();
      const PixelStep result = history.step(scene_edit(edit, journal.file, journal.path.parent_path()));
      causes.insert(result.causes.begin(), result.causes.end());
    });
  }
  return causes;
}

TEST(Blame, says_how_a_change_gets_to_the_pixel) {
  const std::set<std::string> causes = all_causes(parse_journal(kJournal, "blame.json"));
  for (const char* expected :
       {"material Paint: CentralSphere", "node SmallSphere: LeftSphere > reflection > SmallSphere",
        "node SmallSphere: SmallSphere", "node SmallSphere: light Lamp through SmallSphere on Floor",
        "node Cube: shadow from light Lamp on Floor", "light Lamp: on Floor"})
    EXPECT_TRUE(causes.contains(expected)) << expected << ", not among " << Json(causes).dump(1);
}

class BlameProgram : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void SetUp() override {
    std::ofstream(at("j.json")) << kJournal;
    ASSERT_EQ(relook({"preprocess", kSpheres, "--integrator", "whitted", "-o", at("cache"), "--resolution", "96x54",
                      "--quiet"})
                  .exit_code,
              0);
    ASSERT_EQ(relook({"replay", at("cache"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  }
  ScratchFolder folder_{"blame"};
};

TEST_F(BlameProgram, names_steps_and_objects_of_a_pixel) {
  const Journal journal = read_journal(at("j.json"));
  const auto frames = frames_of_replay(journal, {});
  std::size_t pixel = 0;  // the first that the colour changes, by sight of the sphere itself
  while (same_bits(frames[0][pixel], frames[1][pixel])) ++pixel;
  const std::string place = std::to_string(pixel % kWidth) + "," + std::to_string(pixel / kWidth);
  const ProgramResult result = relook({"blame", at("run"), place, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Json found = parse_json(result.output, "blame");
  std::vector<std::string> expected, named;
  const char* const names[] = {"frames/0001.exr", "frames/0002_01.exr", "frames/0002_02.exr", "frames/0003.exr",
                               "frames/0004.exr"};
  for (std::size_t k = 1; k < frames.size(); ++k)
    if (!same_bits(frames[k - 1][pixel], frames[k][pixel])) expected.emplace_back(names[k - 1]);
  for (const Json& change : found["changes"]) named.push_back(change["frame"]);
  EXPECT_EQ(named, expected);
  EXPECT_EQ(found["changes"][0]["name"], "green");
  EXPECT_EQ(found["changes"][0]["class"], "color");
  EXPECT_TRUE(found["changes"][0]["causes"][0].get<std::string>().starts_with("material Paint: "));
  EXPECT_NE(found["paths"].dump().find("CentralSphere [Paint]"), std::string::npos);
}

TEST_F(BlameProgram, a_cache_whose_frame_is_not_its_scenes_is_damage_and_no_abort) {
  CacheContent content;
  ASSERT_EQ(read_cache(at("cache"), content).fault, CacheFault::none);
  content.image.frame.pixels[5 * kWidth + 7].g += 0.25F;
  write_cache(at("other"), content);
  ASSERT_EQ(relook({"replay", at("other"), at("j.json"), "-o", at("run2"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(relook({"blame", at("run2"), "6,5"}).exit_code, 0);
  const ProgramResult result = relook({"blame", at("run2"), "7,5"});
  EXPECT_EQ(result.exit_code, 5) << result.output;
  EXPECT_NE(result.output.find("pixel 7,5: the cache's frame is not that of its scene"), std::string::npos)
      << result.output;
}

TEST_F(BlameProgram, refuses_what_is_no_pixel_and_no_run) {
  const auto expect = [&](const std::vector<std::string>& arguments, int exit_code, const std::string& part) {
    const ProgramResult result = relook(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
  };
  expect({"blame", at("run"), "96,0"}, 1, "the image is 96x54 pixels");
  expect({"blame", at("run"), "1;2"}, 1, "is not a pixel like 120,45");
  expect({"blame", at("cache"), "1,2"}, 2, "report.json");
  std::ofstream(at("j.json"), std::ios::app) << "\n";
  expect({"blame", at("run"), "1,2"}, 2, "is not as it was when");
}

}  // namespace
}  // namespace relook
