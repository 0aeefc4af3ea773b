// Scenes of many lights, whose programs add whichever lamps reach a node: the bits of programs for the lamps that do,
// in renders and after edits, and no more programs for more lamps.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "color/shade.h"
#include "edit/apply.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

const ViewOptions kView{1, 4};

Json set(const std::string& pointer, Json value) {
  return {{"op", "replace"}, {"path", pointer}, {"value", std::move(value)}};
}
Json add(const std::string& pointer, Json value) {
  return {{"op", "add"}, {"path", pointer}, {"value", std::move(value)}};
}

Json lamp_at(const std::string& light, Json translation, Json rotation) {
  return {{"translation", std::move(translation)},
          {"rotation", std::move(rotation)},
          {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
}

/// Lamps around the scene, each a light that the scene has already. Their names stand in the light order on both sides
/// of the scene's own.
void add_lamps(SceneState& state, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = 2.4 * static_cast<double>(i), out = 1.5 + 0.04 * static_cast<double>(i);
    const Json place = {out * std::cos(turn), 3.6, out * std::sin(turn) + 0.4};
    const std::string name = (i % 2 == 0 ? "B" : "S") + std::to_string(i);
    const Json node = lamp_at("Lamp", place, {-0.6427876, 0, 0, 0.7660444});
    (void)apply_edit(state, edit_of(Json::array({add("/nodes/" + name, node)})), "", ".");
  }
}

/// Lamps within an opaque body, from which nothing is lit. With them the scene has more lights than programs tell.
void add_sealed_lamps(SceneState& state, TestScene scene) {
  const Json place = scene == TestScene::spheres ? Json{0, 0.7, -0.7}
                     : scene == TestScene::study ? Json{0, 0.75, -0.4}
                                                 : Json{0.1, 0.6, -1.1};
  for (const std::string name : {"A0", "C0", "M0", "T0", "Z0", "Z1"})
    (void)apply_edit(state, edit_of(Json::array({add("/nodes/" + name, lamp_at("Lamp", place, {0, 0, 0, 1}))})), "",
                     ".");
}

/// A scene with as many lights as programs tell, and the same with sealed ones beside.
struct Twins {
  SceneState told, summed;
};
Twins twins_of(TestScene scene) {
  SceneState told = test_scene(scene, 60, 45);
  // Light of a lamp inside of a body would pass back faces that are not there.
  (void)apply_edit(told, edit_of(Json::array({add("/materials/Matte/doubleSided", true)})), "", ".");
  add_lamps(told, kMostTellingLights - told.scene().light_order.size());
  SceneState summed = compiled_again(told);
  add_sealed_lamps(summed, scene);
  return {std::move(told), std::move(summed)};
}

class LampSums : public testing::TestWithParam<TestScene> {};
INSTANTIATE_TEST_SUITE_P(Scenes, LampSums, testing::Values(TestScene::spheres, TestScene::cards, TestScene::study),
                         [](const auto& test) { return test_scene_name(test.param); });

TEST_P(LampSums, a_render_has_the_bits_of_programs_for_the_lamps_that_reach_a_node) {
  const Twins twins = twins_of(GetParam());
  ASSERT_EQ(twins.told.scene().light_order.size(), kMostTellingLights);
  ASSERT_GT(twins.summed.scene().light_order.size(), kMostTellingLights);
  EXPECT_EQ(different_pixels(rendered(twins.told.scene(), kView), rendered(twins.summed.scene(), kView)).size(), 0U);
}

/// Edits of colours, twice each and in turn, so that trees are compressed, evaluated again, and outdated by others.
std::vector<Json> color_edits() {
  const std::string matte = "/materials/Matte", ground = "/materials/Ground", glass = "/materials/Glass";
  const std::string base = "/pbrMetallicRoughness/baseColorFactor", rough = "/pbrMetallicRoughness/roughnessFactor";
  const std::string sheen = "/extensions/KHR_materials_sheen", coat = "/extensions/KHR_materials_clearcoat";
  const std::string film = "/extensions/KHR_materials_iridescence";
  std::vector<Json> edits;
  edits.push_back(Json::array({add(matte + sheen, {{"sheenColorFactor", {0.2, 0.3, 0.1}}, {"sheenRoughnessFactor", 0.4}}),
                               add(matte + coat, {{"clearcoatFactor", 0.4}, {"clearcoatRoughnessFactor", 0.4}})}));
  edits.push_back(Json::array({add(ground + film, {{"iridescenceFactor", 0.6}, {"iridescenceIor", 1.4}})}));
  edits.push_back(Json::array({add(glass + "/extensions/KHR_materials_dispersion", {{"dispersion", 4}})}));
  for (const double x : {0.35, 0.8, 0.55}) {
    edits.push_back(Json::array({set(matte + base, {x, 0.4, 0.2, 1})}));
    edits.push_back(Json::array({set(matte + sheen + "/sheenColorFactor", {0.1, x, 0.2})}));
    edits.push_back(Json::array({set("/lights/Lamp/color", {1, x, 0.5})}));
    edits.push_back(Json::array({set(matte + coat + "/clearcoatRoughnessFactor", x / 2 + 0.26)}));
    edits.push_back(Json::array({set(ground + base, {0.6, 0.5, x, 1})}));
    edits.push_back(Json::array({set(glass + base, {x, 0.9, 0.7, 1})}));
    edits.push_back(Json::array({set("/scene/extras/relook/ambient", {0.1, x / 5, 0.1})}));
    edits.push_back(Json::array({set(matte + rough, x), set(ground + rough, x)}));
    edits.push_back(Json::array({set("/scene/extras/relook/environment/color", {0.3, 0.2, x})}));
    edits.push_back(Json::array({add(matte + "/emissiveFactor", {x, 0.1, 0.1})}));
    edits.push_back(Json::array({set(ground + film + "/iridescenceFactor", x)}));
  }
  return edits;
}

TEST_P(LampSums, edits_have_the_bits_of_programs_for_the_lamps_that_reach_a_node) {
  Twins twins = twins_of(GetParam());
  Image told_image = preprocessed(twins.told.scene(), kView), image = preprocessed(twins.summed.scene(), kView);
  Replayer told(std::move(twins.told), std::move(told_image), {});
  Replayer summed(std::move(twins.summed), std::move(image), {});
  std::size_t steps = 0, steps_that_changed = 0;
  for (const Json& operations : color_edits()) {
    SCOPED_TRACE(operations.dump());
    const StepResult one = told.step(edit_of(operations), "edits", ".");
    const StepResult other = summed.step(edit_of(operations), "edits", ".");
    ASSERT_EQ(different_pixels(told.image().frame, summed.image().frame).size(), 0U);
    EXPECT_EQ(one.counters.samples_affected, other.counters.samples_affected);
    EXPECT_EQ(one.counters.color_trees_evaluated, other.counters.color_trees_evaluated);
    ++steps;
    steps_that_changed += one.changed_pixels.empty() ? 0 : 1;
  }
  EXPECT_GT(steps_that_changed, steps / 2);
  const SceneState again = compiled_again(summed.state());
  EXPECT_EQ(different_pixels(summed.image().frame, rendered(again.scene(), kView)).size(), 0U);
}

TEST(Lamps, an_edit_of_a_light_counts_the_samples_that_it_reaches) {
  const auto affected = [](bool with_sealed) {
    Twins twins = twins_of(TestScene::study);
    SceneState state = std::move(with_sealed ? twins.summed : twins.told);
    Image image = preprocessed(state.scene(), kView);
    Replayer replayer(std::move(state), std::move(image), {});
    return replayer.step(edit_of(Json::array({set("/lights/Fill/color", {1, 0.2, 0.2})})), "edits", ".")
        .counters.samples_affected;
  };
  EXPECT_EQ(affected(false), affected(true));
}

std::size_t programs_with(std::size_t lamps) {
  SceneState state = test_scene(TestScene::spheres, 60, 45);
  add_lamps(state, lamps - 1);
  const Image image = preprocessed(state.scene(), kView);
  const ColorScene scene(state.scene());
  ProgramTable table;
  std::set<const ColorProgram*> programs;
  for (std::uint32_t path = 0; path < image.paths.size(); ++path) {
    std::vector<NodeKey> keys;
    append_keys(scene, image.paths.words(PathId(path)), scene.light_order(), image.view.shadow_bits, keys);
    for (const NodeKey& key : keys) programs.insert(table.get(state.scene(), key).program);
  }
  return programs.size();
}

TEST(Lamps, there_are_as_many_programs_for_64_lamps_as_for_a_few) {
  const std::size_t few = programs_with(kMostTellingLights + 2);
  EXPECT_GT(few, 4U);
  EXPECT_LE(programs_with(64), few);
}

}  // namespace
}  // namespace relook
