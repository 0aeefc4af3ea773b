// The image quadtree: groups and tunnels stand for the ray trees below them, and finding with them finds all.
#include <gtest/gtest.h>

#include "image/path_classes.h"
#include "image/render.h"
#include "region_checks.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

Replayer replayer_of(TestScene scene, ViewOptions view, const RegionOptions& structures) {
  SceneState state = test_scene(scene, 90, 70);
  Image image = preprocessed(state.scene(), view);
  return Replayer(std::move(state), std::move(image), structures);
}

TEST(Quadtree, EveryPixelIsInItsLeafAndTheRegionsAbove) {
  for (std::uint32_t y = 0; y < kTileSize; ++y)
    for (std::uint32_t x = 0; x < kTileSize; ++x) {
      const std::uint32_t leaf = leaf_of(y * kTileSize + x, kTileSize);
      std::uint32_t holding = 0;
      for (std::uint32_t region = 0; region < kRegions; ++region) {
        const RegionSquare square = square_of(region);
        const bool inside = x >= square.x && x < square.x + square.size && y >= square.y && y < square.y + square.size;
        holding += inside ? 1 : 0;
        if (is_leaf(region)) {
          EXPECT_EQ(inside, region == leaf) << x << " " << y;
        }
      }
      EXPECT_EQ(holding, 5U);
    }
}

TEST(Quadtree, ChildrenPartTheirRegion) {
  for (std::uint32_t region = kLeaves; region < kRegions; ++region) {
    const RegionSquare square = square_of(region);
    std::uint32_t area = 0;
    for (std::uint32_t child : children_of(region)) {
      const RegionSquare part = square_of(child);
      EXPECT_EQ(part.size * 2, square.size);
      EXPECT_TRUE(part.x >= square.x && part.x < square.x + square.size);
      EXPECT_TRUE(part.y >= square.y && part.y < square.y + square.size);
      area += part.size * part.size;
    }
    EXPECT_EQ(area, square.size * square.size);
  }
}

struct TunnelCase {
  TestScene scene;
  std::uint32_t samples;
  std::size_t tunnels;
};

class Tunnels : public testing::TestWithParam<TunnelCase> {};

TEST_P(Tunnels, EverySegmentLiesInItsTunnelAndThoseAbove) {
  const auto [scene, samples, tunnels] = GetParam();
  RegionOptions structures;
  structures.tunnels = tunnels;
  const Replayer replayer = replayer_of(scene, {samples, 6}, structures);
  std::size_t segments = 0;
  EXPECT_EQ(segments_outside(replayer, fresh_regions(replayer), segments), 0U);
  EXPECT_GE(segments, replayer.segments());
}

std::string tunnel_case_name(const testing::TestParamInfo<TunnelCase>& info) {
  return std::string(test_scene_name(info.param.scene)) + "_" + std::to_string(info.param.samples) + "_samples_" +
         std::to_string(info.param.tunnels) + "_tunnels";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Tunnels,
                         testing::Values(TunnelCase{TestScene::spheres, 1, 1}, TunnelCase{TestScene::cards, 1, 2},
                                         TunnelCase{TestScene::study, 1, 3}, TunnelCase{TestScene::study, 4, 1}),
                         tunnel_case_name);

/// By counting the paths in every region.
TEST(Groups, KnowThePathsOfTheirRegions) {
  RegionOptions structures;
  const Replayer replayer = replayer_of(TestScene::spheres, {1, 6}, structures);
  const Image& image = replayer.image();
  std::size_t groups = 0, others = 0;
  for (std::size_t tile = 0; tile < image.trees.size(); ++tile) {
    const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
    const std::uint32_t width = rect.x1 - rect.x0, height = rect.y1 - rect.y0;
    const PathGroups& known = replayer.regions().groups(tile);
    for (std::uint32_t region = 0; region < kRegions; ++region) {
      const RegionSquare square = square_of(region);
      std::vector<PathId> paths;
      for (std::uint32_t y = square.y; y < std::min(square.y + square.size, height); ++y)
        for (std::uint32_t x = square.x; x < std::min(square.x + square.size, width); ++x)
          paths.push_back(image.trees[tile].paths[y * width + x]);
      std::ranges::sort(paths);
      const auto repeated = std::ranges::unique(paths);
      paths.erase(repeated.begin(), repeated.end());
      ASSERT_EQ(known.is_group(region), paths.size() <= structures.groups);
      ++(known.is_group(region) ? groups : others);
      if (!known.is_group(region)) continue;
      std::vector<PathId> listed(known.classes(region).begin(), known.classes(region).end());
      std::ranges::sort(listed);
      EXPECT_EQ(listed, paths);
    }
  }
  EXPECT_GT(groups, 100U);
  EXPECT_GT(others, 10U);
}

TEST(Groups, AreLargerWithAtoms) {
  const Replayer replayer = replayer_of(TestScene::study, {1, 6}, {});
  const auto count = [&](std::uint32_t depth) {
    PathClasses classes(depth > 0);
    classes.extend(replayer.image().paths, layout_of(replayer),
                   depth > 0 ? atoms_of(replayer.state(), depth) : std::vector<ObjectId>());
    return classes.size();
  };
  EXPECT_LE(count(1), count(0));
}

/// An edit to something that no ray comes near.
TEST(Finding, NothingIsTestedWhereTunnelsSeeNothing) {
  Replayer replayer = replayer_of(TestScene::spheres, {1, 6}, {});
  replayer.step(parsed_edit(R"([{"op": "add", "path": "/nodes/Away", "value": {"mesh": "Ball",
                "translation": [0, -50, 0], "scale": [0.1, 0.1, 0.1]}}])"),
                "away", ".");
  const StepResult step = replayer.step(
      parsed_edit(R"([{"op": "replace", "path": "/nodes/Away/translation", "value": [1, -51, 0]}])"), "away", ".");
  EXPECT_EQ(step.counters.ray_tests, 0U);
  EXPECT_EQ(step.counters.samples_affected, 0U);
  EXPECT_GT(step.counters.by_tunnels.culled, 0U);
  EXPECT_EQ(step.counters.ray_tests_culled, replayer.segments());
  EXPECT_EQ(step.counters.culled.tunnels, replayer.segments());
}

TEST(Finding, TheSameSelectionIsNotLookedForTwice) {
  Replayer replayer = replayer_of(TestScene::spheres, {1, 6}, {});
  const auto paint = [&](const char* value) {
    return replayer.step(
        parsed_edit(std::string(R"([{"op": "replace", "path": "/materials/Matte/pbrMetallicRoughness/baseColorFactor",
                    "value": )") +
                    value + "}]"),
        "paint", ".");
  };
  const StepResult first = paint("[0.9, 0.1, 0.1, 1]"), second = paint("[0.1, 0.9, 0.1, 1]");
  EXPECT_GT(first.counters.by_groups.visited, 0U);
  EXPECT_EQ(second.counters.by_groups.visited, 0U);
  EXPECT_EQ(second.counters.samples_affected, first.counters.samples_affected);
  EXPECT_EQ(second.dependent, first.dependent);
  const auto bend = [&](const char* value) {
    return replayer.step(
        parsed_edit(std::string(R"([{"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_ior/ior",
                    "value": )") +
                    value + "}]"),
        "bend", ".");
  };
  EXPECT_GT(bend("1.4").counters.by_groups.visited, 0U);
  EXPECT_EQ(bend("1.6").counters.by_groups.visited, 0U);
  const StepResult third = paint("[0.5, 0.5, 0.1, 1]");
  EXPECT_EQ(third.counters.by_groups.visited, 0U) << "nor after an edit of something else";
  for (std::size_t tile = 0; tile < third.dependent.size(); ++tile)
    EXPECT_EQ(third.dependent[tile] | first.dependent[tile], third.dependent[tile]) << "none is forgotten";
}

TEST(Finding, TunnelsLeaveFewSegmentsToLookAt) {
  std::uint64_t tests[2] = {0, 0}, looked_at[2] = {0, 0};
  for (const std::size_t tunnels : {0U, 1U}) {
    RegionOptions structures;
    structures.tunnels = tunnels;
    Replayer replayer = replayer_of(TestScene::spheres, {1, 6}, structures);
    const StepResult step = replayer.step(
        parsed_edit(R"([{"op": "replace", "path": "/nodes/Ball/translation", "value": [0.1, 0.9, 0.1]}])"), "ball",
        ".");
    tests[tunnels] = step.counters.ray_tests;
    looked_at[tunnels] = step.counters.ray_tests + step.counters.culled.boxes;
  }
  EXPECT_GT(tests[1], 0U);
  EXPECT_EQ(tests[1], tests[0]);  // boxes leave out the same without them
  EXPECT_LT(looked_at[1] * 2, looked_at[0]);
}

TEST(Groups, StayFreshWhenTheHierarchyChanges) {
  RegionOptions regions;
  regions.atoms = 1;
  Replayer replayer = replayer_of(TestScene::spheres, {1, 6}, regions);
  const auto step = [&](const char* edit) {
    replayer.step(parsed_edit(edit), "atoms", ".");
    EXPECT_EQ(stale_tiles(replayer), 0U) << edit;
  };
  step(R"([{"op": "add", "path": "/nodes/Pair", "value": {"mesh": "Ball", "translation": [1, 1, 1]}}])");
  step(R"([{"op": "add", "path": "/nodes/Part", "value": {"mesh": "Ball", "translation": [0.2, 1, 1.5]}}])");
  step(R"([{"op": "add", "path": "/nodes/Pair/children", "value": ["Part"]}])");
  step(R"([{"op": "replace", "path": "/nodes/Pair/children", "value": []}])");
}

TEST(Groups, OfASceneThatGetsItsFirstObjectKnowAtoms) {
  SceneBuilder scene;
  scene.mesh("Ball", sphere_mesh(1, 8, 6), scene.material("Matte", Json::object()));
  scene.light("Lamp", {{"type", "point"}, {"intensity", 60}}, {{"translation", {2, 4, 3}}});
  scene.look_at(Point(0, 0, 5), Point(0, 0, 0), 40, 32, 32);
  SceneState state = scene.state();
  Image image = preprocessed(state.scene(), {1, 6});
  RegionOptions regions;
  regions.atoms = 1;
  Replayer replayer(std::move(state), std::move(image), regions);
  for (const char* name : {"First", "Second"}) {
    replayer.step(parsed_edit(std::string(R"([{"op": "add", "path": "/nodes/)") + name +
                              R"(", "value": {"mesh": "Ball", "translation": [0.3, 0, 0]}}])"),
                  "atoms", ".");
    EXPECT_EQ(stale_tiles(replayer), 0U) << name;
  }
}

/// Both passes of a drag's first frame count: over the trees with the selection, and over those without it.
TEST(Drag, CountsEachStoredSegmentOncePerPass) {
  for (const std::size_t tunnels : {0U, 1U}) {
    RegionOptions regions;
    regions.tunnels = tunnels;
    Replayer replayer = replayer_of(TestScene::spheres, {1, 6}, regions);
    const auto total = [](const StepResult& step) { return step.counters.ray_tests + step.counters.ray_tests_culled; };
    const auto drag = [&](const char* place) {
      const StepResult step = replayer.drag(
          parsed_edit(std::string(R"([{"op": "replace", "path": "/nodes/Ground/translation", "value": )") + place +
                      "}]"),
          "drag", ".");
      EXPECT_LE(step.counters.samples_affected, step.counters.samples_total);
      return step;
    };
    const std::uint64_t before = replayer.segments();
    const StepResult first = drag("[0.1, 0, 0]");
    const std::uint64_t without = replayer.segments();
    EXPECT_LT(without, before);
    EXPECT_EQ(total(first), before + without);
    EXPECT_EQ(total(drag("[0.2, 0, 0]")), without);
    EXPECT_EQ(total(replayer.release()), without);
    EXPECT_EQ(total(replayer.release()), replayer.segments());  // nothing to release
  }
}

}  // namespace
}  // namespace relook
