// Colour trees that are kept for some sets of parameters while others, and everything else, change in between: the
// frame stays that of a full render, however many trees may be kept.
#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "image/render.h"
#include "region_checks.h"
#include "replay/chosen_parameters.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

struct Parameter {
  const char* pointer;
  enum Kind { number, color, color_with_alpha } kind;
  double low = 0, high = 1;
};

/// Parameters that colour edits come back to; the optical and geometric ones at the end come in between.
const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> all{
      {"/materials/Matte/pbrMetallicRoughness/baseColorFactor", Parameter::color_with_alpha},
      {"/materials/Matte/pbrMetallicRoughness/roughnessFactor", Parameter::number, 0.4, 1},
      {"/materials/Matte/pbrMetallicRoughness/metallicFactor", Parameter::number},
      {"/materials/Ground/pbrMetallicRoughness/baseColorFactor", Parameter::color_with_alpha},
      {"/materials/Mirror/pbrMetallicRoughness/baseColorFactor", Parameter::color_with_alpha},
      {"/materials/Mirror/extras/relook/reflection", Parameter::number, 0.1, 1},
      {"/materials/Glass/extensions/KHR_materials_volume/attenuationColor", Parameter::color},
      {"/materials/Glass/pbrMetallicRoughness/baseColorFactor", Parameter::color_with_alpha},
      {"/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor", Parameter::number, 0.2, 1},
      {"/lights/Lamp/intensity", Parameter::number, 5, 60},
      {"/lights/Lamp/color", Parameter::color},
      {"/scene/extras/relook/ambient", Parameter::color},
      {"/scene/extras/relook/environment/color", Parameter::color},
      {"/scene/extras/relook/environment/rotation", Parameter::number, 0, 6},
      {"/textures/Marble/extras/relook/procedural/color1", Parameter::color},
      {"/textures/Marble/extras/relook/procedural/scale", Parameter::number, 1, 4},
      {"/materials/Matte/extras/relook/diffuse", Parameter::color},
      {"/materials/Matte/extensions/KHR_materials_sheen/sheenColorFactor", Parameter::color},
      {"/materials/Matte/extensions/KHR_materials_anisotropy/anisotropyStrength", Parameter::number, 0.1, 1},
      {"/materials/Matte/extensions/KHR_materials_anisotropy/anisotropyRotation", Parameter::number, -3, 3},
      {"/materials/Mirror/extensions/KHR_materials_iridescence/iridescenceFactor", Parameter::number, 0.1, 1},
      {"/materials/Mirror/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", Parameter::number, 200,
       800},
      {"/nodes/Ball/translation/1", Parameter::number, 0.6, 1.4},
      {"/nodes/GlassBall/translation/0", Parameter::number, 0.5, 1.5},
      {"/materials/Glass/extensions/KHR_materials_ior/ior", Parameter::number, 1.1, 2},
      {"/materials/Mirror/pbrMetallicRoughness/roughnessFactor", Parameter::number, 0, 0.5},
  };
  return all;
}

class Values {
 public:
  explicit Values(std::uint64_t seed) : engine_(seed) {}
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  Json of(const Parameter& parameter) {
    if (parameter.kind == Parameter::number) return between(parameter.low, parameter.high);
    Json color{between(0, 1), between(0, 1), between(0, 1)};
    if (parameter.kind == Parameter::color_with_alpha) color.push_back(between(0.3, 1));
    return color;
  }

 private:
  double between(double low, double high) { return low + (high - low) * static_cast<double>(below(65)) / 64; }
  std::mt19937_64 engine_;
};

void expect_full_render(const Replayer& replayer, const StepResult& step, const Frame& before) {
  const SceneState again = compiled_again(replayer.state());
  const Frame full = rendered(again.scene(), replayer.image().view);
  ASSERT_EQ(different_pixels(replayer.image().frame, full).size(), 0U);
  ASSERT_EQ(step.changed_pixels.indices(full.width), different_pixels(before, full));
}

struct RecolorCase {
  TestScene scene;
  std::uint32_t samples;
  double color_trees;
  std::vector<std::string> chosen = {};  // pointers; none: every set that is edited
};
class Recolor : public testing::TestWithParam<RecolorCase> {};

TEST_P(Recolor, ParametersInTurnsWithOtherEditsInBetween) {
  const RecolorCase& c = GetParam();
  SceneState state = test_scene(c.scene, 150 / c.samples, 110 / c.samples);  // several tiles
  Image image = preprocessed(state.scene(), {c.samples, 5, 0});
  RegionOptions options;
  options.color_trees = c.color_trees;
  std::vector<ParameterSet> chosen;
  for (const std::string& pointer : c.chosen) chosen.push_back(parameters_at(state, pointer));
  Replayer replayer(std::move(state), std::move(image), options);
  if (!chosen.empty()) replayer.choose_parameters(chosen);
  Values values(1996 + c.samples);
  std::vector<std::size_t> few;  // mostly these in turns
  for (int i = 0; i < 4; ++i) few.push_back(values.below(parameters().size()));
  for (int k = 0; k < 160; ++k) {
    if (k % 8 == 0) few[values.below(few.size())] = values.below(parameters().size());
    const Parameter& parameter = parameters()[few[values.below(few.size())]];
    const Json value = values.of(parameter);
    SCOPED_TRACE("step " + std::to_string(k) + ": " + parameter.pointer + " = " + value.dump());
    const Frame before = replayer.image().frame;
    const StepResult step = replayer.step(replace_edit(parameter.pointer, value), "recolor", ".");
    ASSERT_NO_FATAL_FAILURE(expect_full_render(replayer, step, before));
    ASSERT_LE(step.counters.pixels_changed, step.counters.samples_affected);
  }
}

std::vector<RecolorCase> recolor_cases() {
  std::vector<RecolorCase> cases;
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study})
    for (const double share : {0.0, 0.05, 1.0}) cases.push_back({scene, 1, share});
  cases.push_back({TestScene::study, 4, 1.0});
  cases.push_back({TestScene::cards, 4, 0.2});
  cases.push_back({TestScene::spheres, 1, 1.0, {"/materials/Matte", "/lights/Lamp", "/materials/Glass"}});
  cases.push_back({TestScene::study, 1, 1.0, {"/scene/extras/relook", "/textures/Marble", "/materials"}});
  cases.push_back({TestScene::cards, 1, 0.1, {"/lights/Lamp/color", "/lights/Lamp/intensity", "/materials/Mirror"}});
  return cases;
}
std::string case_name(const testing::TestParamInfo<RecolorCase>& info) {
  return std::string(test_scene_name(info.param.scene)) + "_" + std::to_string(info.param.samples) + "_samples_" +
         std::to_string(static_cast<int>(info.param.color_trees * 100)) + "_percent" +
         (info.param.chosen.empty() ? "" : "_chosen");
}
INSTANTIATE_TEST_SUITE_P(Scenes, Recolor, testing::ValuesIn(recolor_cases()), case_name);

TEST(RecolorCost, TheSecondEditOfAParameterLooksForNothing) {
  SceneState state = test_scene(TestScene::study, 150, 110);
  Image image = preprocessed(state.scene(), {1, 5, 0});
  Replayer replayer(std::move(state), std::move(image));
  const char* pointer = "/materials/Matte/pbrMetallicRoughness/baseColorFactor";
  const StepResult first = replayer.step(replace_edit(pointer, {0.1, 0.2, 0.3, 1}), "recolor", ".");
  const StepResult second = replayer.step(replace_edit(pointer, {0.3, 0.2, 0.1, 1}), "recolor", ".");
  EXPECT_GT(first.counters.by_groups.visited, 0U);
  EXPECT_EQ(second.counters.by_groups.visited, 0U);
  EXPECT_EQ(first.counters.samples_affected, second.counters.samples_affected);
  EXPECT_GT(replayer.resident().color_trees, first.counters.samples_affected * sizeof(Rgba));
}

TEST(ChosenParameters, AreWhatCanChangeBelowAPointer) {
  const SceneState before = test_scene(TestScene::study, 40, 30);
  SceneState state = test_scene(TestScene::study, 40, 30);
  const ParameterSet factor = parameters_at(state, "/materials/Matte/pbrMetallicRoughness/baseColorFactor");
  ASSERT_EQ(factor.materials.size(), 1U);
  EXPECT_EQ(factor.materials[0].second, mask_of(Field::base_color));
  EXPECT_EQ(parameters_at(state, "/materials/Matte/pbrMetallicRoughness/baseColorFactor/2"), factor);
  const ParameterSet all = parameters_at(state, "/materials/Matte");
  EXPECT_TRUE(all.contains(factor));
  EXPECT_FALSE(factor.contains(all));
  EXPECT_NE(all.materials[0].second & mask_of(Field::roughness), 0U);
  EXPECT_EQ(parameters_at(state, "/lights/Lamp/intensity").lights.size(), 1U);
  EXPECT_TRUE(parameters_at(state, "/scene/extras/relook/environment").environment);
  EXPECT_EQ(state.document().look, before.document().look);
  for (const char* pointer : {"/materials/Mat", "/nodes/Ball/translation", "materials", "/materials/Glass/name",
                              "/materials/Glass/extensions/KHR_materials_ior/ior"})
    EXPECT_THROW((void)parameters_at(state, pointer), InputError) << pointer;
}

TEST(RecolorCost, TheFirstEditOfAChosenParameterLooksForNothing) {
  SceneState state = test_scene(TestScene::study, 150, 110);
  const char* pointer = "/materials/Matte/pbrMetallicRoughness/baseColorFactor";
  const std::vector<ParameterSet> chosen{parameters_at(state, pointer)};
  Image image = preprocessed(state.scene(), {1, 5, 0});
  Replayer replayer(std::move(state), std::move(image));
  replayer.choose_parameters(chosen);
  const std::uint64_t kept = replayer.resident().color_trees;
  const StepResult first = replayer.step(replace_edit(pointer, {0.1, 0.2, 0.3, 1}), "recolor", ".");
  EXPECT_EQ(first.counters.by_groups.visited, 0U);
  EXPECT_GT(first.counters.samples_affected, 0U);
  const StepResult other = replayer.step(replace_edit("/lights/Lamp/color", {0.5, 1, 1}), "recolor", ".");
  EXPECT_GT(other.counters.by_groups.visited, 0U);
  EXPECT_LE(replayer.resident().color_trees, kept) << "no trees of a light that was not chosen";
}

TEST(RecolorCost, NoMoreColorTreesAreKeptThanAllowed) {
  SceneState state = test_scene(TestScene::spheres, 150, 110);
  Image image = preprocessed(state.scene(), {1, 5, 0});
  RegionOptions options;
  options.color_trees = 0.3;
  Replayer replayer(std::move(state), std::move(image), options);
  const std::uint64_t before = replayer.resident().color_trees;
  const char* pointer = "/lights/Lamp/intensity";  // reaches nearly all samples
  for (int k = 0; k < 3; ++k) {
    const StepResult step = replayer.step(replace_edit(pointer, 21 + k), "recolor", ".");
    const auto allowed = static_cast<std::uint64_t>(0.3 * static_cast<double>(step.counters.samples_total));
    EXPECT_GT(step.counters.samples_affected, allowed);
    EXPECT_GE(step.counters.evicted.color_trees, step.counters.samples_affected - allowed);
    EXPECT_LT(step.counters.evicted.color_trees, step.counters.samples_affected) << "some tile is kept";
    EXPECT_GT(replayer.resident().color_trees, before);
  }
}

TEST(RecolorCost, TheSecondEditOfALightLooksForNothing) {
  SceneState state = test_scene(TestScene::spheres, 150, 110);
  Image image = preprocessed(state.scene(), {1, 5, 0});
  Replayer replayer(std::move(state), std::move(image));
  const StepResult first = replayer.step(replace_edit("/lights/Lamp/intensity", 21), "recolor", ".");
  const StepResult second = replayer.step(replace_edit("/lights/Lamp/intensity", 22), "recolor", ".");
  EXPECT_GT(first.counters.by_groups.visited, 0U);
  EXPECT_EQ(second.counters.by_groups.visited, 0U);
  EXPECT_EQ(first.counters.samples_affected, second.counters.samples_affected);
}

}  // namespace
}  // namespace relook
