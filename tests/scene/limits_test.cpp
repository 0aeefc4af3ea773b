// Limits that are the format's, or none: names of any length and alphabet, thousands of lights. What exceeds a real
// limit is refused with a sentence.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/byte_columns.h"
#include "base/error.h"
#include "edit/apply.h"
#include "frame/frame_layers.h"
#include "image/layers/layered_frame.h"
#include "layer_file.h"
#include "replay/replay.h"
#include "run_program.h"
#include "test_scenes.h"

namespace relook {
namespace {

Json lamp(double intensity) { return {{"type", "point"}, {"color", {1, 0.9, 0.8}}, {"intensity", intensity}}; }

/// A box on a floor.
SceneBuilder box_on_floor(std::uint32_t side) {
  SceneBuilder builder;
  const int grey = builder.material("Grey", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.4, 0.3, 1}}}}});
  builder.node("Floor", {{"mesh", builder.mesh("Floor", plane_mesh(4, 1), grey)}});
  builder.node("Box",
               {{"mesh", builder.mesh("Box", box_mesh({0.3F, 0.6F, 0.3F}), grey)}, {"translation", {0, 0.6, 0}}});
  builder.look_at({0, 3, 5}, {0, 0.4F, 0}, 40, side, side);
  return builder;
}

Json over_the_floor(std::size_t i, std::size_t count) {
  const double turn = 6.283 * static_cast<double>(i) / static_cast<double>(count);
  return {{"translation", {3 * std::cos(turn), 1 + static_cast<double>(i % 7) * 0.3, 3 * std::sin(turn)}}};
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

class Limits : public testing::Test {
 protected:
  [[nodiscard]] LayerFile layers(const SceneState& state) {
    const ViewOptions view{1, 6, 0};
    const Frame frame = rendered(state.scene(), view);
    return read_layers(encode_layered_exr({state.scene(), view, frame, {}, PixelFormat::half}, {}), folder_ / "l.exr");
  }
  ScratchFolder folder_{"limits"};
};

TEST_F(Limits, lamps_may_have_names_of_any_length_and_alphabet) {
  SceneBuilder builder = box_on_floor(16);
  const std::string long_name = repeated("キーライト", 40);  // 600 bytes
  const std::vector<std::string> names{"A lamp of 24 bytes here",
                                       "A.lamp with.dots\u00a0and\u3000spaces, {\"odd\"}",
                                       "Освещение-1",
                                       "مصباح",
                                       "灯\u202e反",
                                       "💡",
                                       long_name,
                                       long_name + "2",
                                       std::string(300, 'x'),
                                       std::string(301, 'x')};
  for (std::size_t i = 0; i < names.size(); ++i) builder.light(names[i], lamp(20), over_the_floor(i, names.size()));
  const LayerFile file = layers(builder.state());

  const std::vector<std::string> sum = file.layers_of_sum("relook:lights");
  const std::set<std::string> listed(sum.begin(), sum.end());
  EXPECT_EQ(listed.size(), names.size() + 4);  // ambient, environment, emission, the rest
  for (const std::string& layer : sum) {
    EXPECT_TRUE(file.channels.contains(layer + ".B")) << layer;
    EXPECT_LE(layer.size(), 253U) << layer;
    EXPECT_EQ(printable(layer), layer);
  }
  for (const std::string name :
       {"A_lamp_of_24_bytes_here", "A_lamp_with_dots_and_spaces____odd__", "Освещение-1", "مصباح", "灯_反", "💡"})
    EXPECT_TRUE(listed.contains("light_" + name)) << name;
  EXPECT_TRUE(listed.contains("light_" + repeated("キーライト", 16) + "キー"));
  EXPECT_TRUE(listed.contains("light_" + repeated("キーライト", 16) + "キ_2"));
  EXPECT_TRUE(listed.contains("light_" + std::string(247, 'x')));
  EXPECT_TRUE(listed.contains("light_" + std::string(245, 'x') + "_2"));
}

TEST_F(Limits, other_programs_read_long_names_and_other_alphabets) {
  SceneBuilder builder = box_on_floor(16);
  const std::string name = repeated("キーライト", 3);
  builder.light(name, lamp(20), over_the_floor(0, 2));
  builder.light(std::string(200, 'n'), lamp(20), over_the_floor(1, 2));
  (void)layers(builder.state());
  const std::string path = (folder_ / "l.exr").string();
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"oiiotool", "--info", "-v", path}, std::vector<std::string>{"exrheader", path}}) {
    if (run_program({"sh", "-c", "command -v " + command[0]}).exit_code != 0) continue;
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_NE(result.output.find("light_" + name + ".R"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("light_" + std::string(200, 'n') + ".B"), std::string::npos) << result.output;
  }
}

TEST_F(Limits, files_without_long_names_do_not_say_that_they_have_some) {
  const std::vector<Bytes> tiles(1, Bytes(2));  // one half
  const auto version_of = [&](const std::string& name) {
    const std::vector<ExrChannel> channels{{name, PixelFormat::half}};
    return std::to_integer<unsigned>(tiled_exr(1, 1, channels, {}, tiles)[5]);
  };
  EXPECT_EQ(version_of(std::string(31, 'n')) & 4U, 0U);
  EXPECT_EQ(version_of(std::string(32, 'n')) & 4U, 4U);
}

TEST_F(Limits, what_openexr_refuses_is_an_error_and_no_abort) {
  const std::vector<Bytes> tiles(1, Bytes(2));  // one half
  const std::vector<ExrChannel> channels{{std::string(300, 'n'), PixelFormat::half}};
  EXPECT_THROW((void)tiled_exr(1, 1, channels, {}, tiles), IoError);
}

TEST_F(Limits, more_lamps_than_layers_are_refused_with_a_sentence) {
  Scene scene;
  scene.light_order.resize(43'000);
  EXPECT_NO_THROW(require_layers(scene));
  scene.light_order.resize(44'000);
  EXPECT_THROW(require_layers(scene), UsageError);
  EXPECT_THROW(FrameLayers(scene, 1, PixelFormat::half), UsageError);
}

class ManyLights : public testing::TestWithParam<TestScene> {
 protected:
  /// The test scene, and `count` dark lamps that come after its own in every sum.
  [[nodiscard]] SceneState with_dark_lamps(int count) const {
    SceneState state = test_scene(GetParam(), 40, 30);
    Json operations = Json::array();
    for (int i = 0; i < count; ++i) {
      const std::string name = "z" + std::to_string(i);
      operations.push_back({{"op", "add"}, {"path", "/lights/" + name}, {"value", lamp(0)}});
      operations.push_back({{"op", "add"},
                            {"path", "/nodes/" + name},
                            {"value",
                             {{"translation", {i % 5 - 2, 2 + i % 3, i % 7 - 3}},
                              {"extensions", {{"KHR_lights_punctual", {{"light", name}}}}}}}});
    }
    if (count > 0) (void)apply_edit(state, edit_of(operations), "j", "");
    return state;
  }
};

INSTANTIATE_TEST_SUITE_P(Scenes, ManyLights, testing::Values(TestScene::spheres, TestScene::cards, TestScene::study),
                         [](const auto& scene) { return std::string(test_scene_name(scene.param)); });

TEST_P(ManyLights, programs_that_ask_give_the_bits_of_those_that_know) {
  const ViewOptions view{2, 6, 0};
  const Frame known = rendered(with_dark_lamps(0).scene(), view);
  EXPECT_TRUE(different_pixels(known, rendered(with_dark_lamps(20).scene(), view)).empty());
  EXPECT_TRUE(different_pixels(known, rendered(with_dark_lamps(40).scene(), view)).empty());
}

TEST_P(ManyLights, a_replay_equals_full_renders) {
  SceneState state = with_dark_lamps(40);
  const ViewOptions view{2, 6, 2};
  Image image = preprocessed(state.scene(), view);
  Replayer replayer(std::move(state), std::move(image));
  for (const Edit& edit :
       {replace_edit("/lights/z3/intensity", 60),
        replace_edit("/materials/Matte/pbrMetallicRoughness/roughnessFactor", 0.3),
        replace_edit("/nodes/z7/translation", Json::array({0.5, 2.5, 1})), replace_edit("/lights/z7/intensity", 90),
        replace_edit("/nodes/Ball/translation", Json::array({0.3, 1, 0.2})),
        edit_of(Json::array({{{"op", "remove"}, {"path", "/nodes/z3"}}}))}) {
    const StepResult result = replayer.step(edit, "j", "");
    EXPECT_GT(result.counters.samples_affected, 0U);
    EXPECT_TRUE(different_pixels(replayer.image().frame, rendered(replayer.state().scene(), view)).empty());
  }
}

TEST_F(Limits, six_thousand_lights_are_rendered_replayed_and_split_into_layers) {
  SceneBuilder builder = box_on_floor(8);
  constexpr std::size_t kLights = 6000;
  for (std::size_t i = 0; i < kLights; ++i)
    builder.light("L" + std::to_string(i), lamp(0.01), over_the_floor(i, kLights));
  SceneState state = builder.state();
  const LayerFile file = layers(state);
  EXPECT_EQ(file.layers_of_sum("relook:lights").size(), kLights + 4);
  EXPECT_EQ(file.sum("relook:lights", "G"), file.channel("G"));

  const ViewOptions view{1, 6, 0};
  Image image = preprocessed(state.scene(), view);
  EXPECT_TRUE(different_pixels(image.frame, rendered(state.scene(), view)).empty());
  Replayer replayer(std::move(state), std::move(image));
  (void)replayer.step(replace_edit("/lights/L17/intensity", 100), "j", "");
  EXPECT_TRUE(different_pixels(replayer.image().frame, rendered(replayer.state().scene(), view)).empty());
}

TEST(ByteColumns, that_a_disk_has_changed_are_an_error_and_no_abort) {
  ByteColumns columns;
  columns.append(std::vector<float>{1, 2, 3});
  const Bytes whole = columns.take();
  std::vector<float> column;
  ByteColumnsReader(whole).next(column);
  EXPECT_EQ(column, (std::vector<float>{1, 2, 3}));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(ByteColumnsReader(BytesView(whole).first(size)).next(column), IoError) << size;
  Bytes larger = whole;
  larger[7] = std::byte{0xFF};  // of the count
  EXPECT_THROW(ByteColumnsReader(larger).next(column), IoError);
}

}  // namespace
}  // namespace relook
