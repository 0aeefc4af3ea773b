// Selection-dependent preprocessing (paper 3.1): edits that take turns search once each, find what a fresh search
// finds, and search again after what makes it doubtful.
#include "replay/kept_selection.h"

#include <gtest/gtest.h>

#include "image/render.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

constexpr ViewOptions kView{1, 5};
constexpr const char* kBaseColor = "/materials/Matte/pbrMetallicRoughness/baseColorFactor";
constexpr const char* kRoughness = "/materials/Matte/pbrMetallicRoughness/roughnessFactor";
constexpr const char* kIor = "/materials/Glass/extensions/KHR_materials_ior/ior";

Replayer replayer_of(SceneState state) {
  RegionOptions options;
  options.color_trees = 0;  // or later edits of a parameter look for nothing in any case
  Image image = preprocessed(state.scene(), kView);
  return Replayer(std::move(state), std::move(image), options);
}

/// A step's counters; its frame and what it looked at are those of a replay that starts there.
Counters step(Replayer& replayer, const std::string& pointer, const Json& value) {
  Replayer fresh = replayer_of(compiled_again(replayer.state()));
  const Edit edit = replace_edit(pointer, value);
  const StepResult expected = fresh.step(edit, "fresh", "."), result = replayer.step(edit, "step", ".");
  EXPECT_EQ(result.counters.samples_affected, expected.counters.samples_affected);
  EXPECT_EQ(result.counters.ray_updates, expected.counters.ray_updates);
  EXPECT_EQ(result.changed_pixels.indices(160), expected.changed_pixels.indices(160));
  const SceneState again = compiled_again(replayer.state());
  EXPECT_EQ(different_pixels(replayer.image().frame, rendered(again.scene(), kView)).size(), 0U);
  return result.counters;
}

TEST(SelectionFlags, OutliveEditsOfOtherFields) {
  Replayer replayer = replayer_of(spheres_scene(160, 120));
  const Counters first = step(replayer, kBaseColor, {0.1, 0.2, 0.3, 1});
  const Counters other = step(replayer, kRoughness, 0.7);
  EXPECT_GT(first.by_groups.visited, 0U);
  EXPECT_GT(other.by_groups.visited, 0U);
  EXPECT_GT(first.samples_affected, 0U);
  for (const double value : {0.5, 0.8}) {
    EXPECT_EQ(step(replayer, kBaseColor, {value, 0.2, 0.3, 1}).by_groups.visited, 0U);
    EXPECT_EQ(step(replayer, kRoughness, value).by_groups.visited, 0U);
  }
}

TEST(SelectionFlags, OutliveOpticalEditsAndTheTreesThatTheseChange) {
  Replayer replayer = replayer_of(spheres_scene(160, 120));
  EXPECT_GT(step(replayer, kBaseColor, {0.1, 0.2, 0.3, 1}).by_groups.visited, 0U);
  EXPECT_GT(step(replayer, kIor, 1.1).by_groups.visited, 0U);
  for (const double value : {1.7, 1.3, 2.0}) {
    EXPECT_EQ(step(replayer, kBaseColor, {value / 3, 0.2, 0.3, 1}).by_groups.visited, 0U);
    EXPECT_EQ(step(replayer, kIor, value).by_groups.visited, 0U);
  }
}

TEST(SelectionFlags, GoWhenSomethingMoves) {
  Replayer replayer = replayer_of(spheres_scene(160, 120));
  EXPECT_GT(step(replayer, kBaseColor, {0.1, 0.2, 0.3, 1}).by_groups.visited, 0U);
  step(replayer, "/nodes/Ball/translation", {0.4, 0.7, -0.5});
  EXPECT_GT(step(replayer, kBaseColor, {0.3, 0.2, 0.1, 1}).by_groups.visited, 0U);
}

TEST(SelectionFlags, GoWhenAProgramMayReadMore) {
  Replayer replayer = replayer_of(spheres_scene(160, 120));
  EXPECT_GT(step(replayer, "/lights/Lamp/intensity", 40).by_groups.visited, 0U);
  EXPECT_GT(step(replayer, kBaseColor, {0.1, 0.2, 0.3, 1}).by_groups.visited, 0U);
  EXPECT_EQ(step(replayer, "/lights/Lamp/intensity", 50).by_groups.visited, 0U);
  step(replayer, "/materials/Ground/pbrMetallicRoughness/baseColorTexture", {{"index", "Marble"}});
  EXPECT_GT(step(replayer, "/lights/Lamp/intensity", 60).by_groups.visited, 0U);
  EXPECT_EQ(step(replayer, kBaseColor, {0.2, 0.2, 0.3, 1}).by_groups.visited, 0U) << "another material's";
}

StepChange change_of_material(std::uint32_t material) {
  StepChange change = no_change({});
  change.colors.parameters.materials = {{MaterialId(material), 1}};
  return change;
}

TEST(SelectionFlags, AreKeptByTheirWeightWithinABudget) {
  const PathTasks tasks{std::vector<std::uint8_t>(1000, 2), std::vector<std::uint8_t>(1000, 2), true};
  const auto fill = [&](KeptSelection& kept) {
    for (std::uint32_t material = 0; material < 6; ++material)
      kept.keep(change_of_material(material), tasks, std::vector<Leaves>(4), material == 1 ? 10.0 : 0.1);
  };
  KeptSelection all(1U << 20), none(0);
  fill(all);
  fill(none);
  EXPECT_EQ(all.size(), 6U);
  EXPECT_EQ(none.size(), 1U);
  EXPECT_NE(none.leaves(change_of_material(5)), nullptr) << "the last step's is kept in any case";
  KeptSelection some(all.bytes() / 2);
  fill(some);
  EXPECT_EQ(some.size(), 3U);
  EXPECT_LE(some.bytes(), all.bytes() / 2);
  EXPECT_NE(some.leaves(change_of_material(1)), nullptr) << "the most expensive to find again";
  EXPECT_NE(some.leaves(change_of_material(4)), nullptr);
  EXPECT_EQ(some.leaves(change_of_material(0)), nullptr);
}

}  // namespace
}  // namespace relook
