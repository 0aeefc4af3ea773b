// Trees that hold nothing and trees that are not kept are two things: steps count what brute force counts over the
// trees before and after, whether hits are kept or found again, and where there are none to keep.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/render.h"
#include "engine/replay.h"
#include "test_scenes.h"
#include "tree_reader.h"

namespace relook {
namespace {

constexpr ViewOptions kView{1, 6};

/// The spheres below a sky of two tiles that see nothing else.
SceneState below_the_sky() { return spheres_scene(96, 256); }

Replayer replayer_of(SceneState state, const RegionOptions& options, const ViewOptions& view = kView) {
  Image image = preprocessed(state.scene(), view);
  return Replayer(std::move(state), std::move(image), options);
}

std::size_t sky_tiles(const Image& image) {
  return static_cast<std::size_t>(std::ranges::count_if(image.trees, [&](const TileTrees& tile) {
    return tile.hits.empty() && !tile.first_hit.empty() && !tile.paths.empty();
  }));
}

/// Calls visit(tree before, tree after) for every sample.
template <class Visit>
void for_each_pair(const Image& before, std::size_t lights_before, const Image& after, std::size_t lights_after,
                   const Visit& visit) {
  for (std::size_t tile = 0; tile < before.trees.size(); ++tile)
    for (std::size_t sample = 0; sample < before.trees[tile].paths.size(); ++sample)
      visit(read_tree(before, tile, sample, lights_before), read_tree(after, tile, sample, lights_after));
}

bool faces_a_light(const TreeNode& node) {
  return std::ranges::any_of(node.lights, [](const TreeLight& l) { return l.state != ShadowState::facing_away; }) ||
         std::ranges::any_of(node.children, [](const auto& child) { return faces_a_light(child.second); });
}

bool names(const TreeNode& node, const Scene& scene, std::string_view of_node) {
  const auto is_it = [&](std::uint32_t object) { return scene.objects[object].node == of_node; };
  if (node.missed) return false;
  if (is_it(node.object)) return true;
  for (const TreeLight& light : node.lights)
    if (std::ranges::any_of(light.filters, [&](const TreeCrossing& f) { return is_it(f.object); })) return true;
  return std::ranges::any_of(node.children, [&](const auto& child) { return names(child.second, scene, of_node); });
}

void expect_full_frame(const Replayer& replayer) {
  const SceneState again = compiled_again(replayer.state());
  EXPECT_EQ(different_pixels(replayer.image().frame, rendered(again.scene(), replayer.image().view)).size(), 0U);
}

TEST(SkyTiles, AreLeftAloneWhenALightMoves) {
  for (const std::size_t tunnels : {0U, 1U})
    for (const double ray_trees : {1.0}) {
      RegionOptions options;
      options.tunnels = tunnels;
      options.ray_trees = ray_trees;
      const SceneState state = below_the_sky();
      const Image before = preprocessed(state.scene(), kView);
      ASSERT_EQ(sky_tiles(before), 2U);
      Replayer replayer = replayer_of(below_the_sky(), options);
      const StepResult step = replayer.step(replace_edit("/nodes/Lamp/translation", {1.5, 3.5, 2}), "m", ".");
      const Image after = preprocessed(compiled_again(replayer.state()).scene(), kView);
      std::uint64_t affected = 0;
      for_each_pair(before, 1, after, 1, [&](const TreeNode& then, const TreeNode& now) {
        affected += faces_a_light(then) || faces_a_light(now) ? 1 : 0;
      });
      EXPECT_EQ(step.counters.samples_affected, affected);
      EXPECT_EQ(step.counters.ray_updates, 0U);
      EXPECT_EQ(step.counters.shadow_updates, size_of(after, 1).shadows);
      expect_full_frame(replayer);
    }
}

TEST(SkyTiles, AreLeftAloneWhenAnObjectMovesElsewhere) {
  for (const std::size_t tunnels : {0U, 1U})
    for (const double ray_trees : {1.0}) {
      RegionOptions options;
      options.tunnels = tunnels;
      options.ray_trees = ray_trees;
      const SceneState state = below_the_sky();
      const Image before = preprocessed(state.scene(), kView);
      Replayer replayer = replayer_of(below_the_sky(), options);
      const StepResult step = replayer.step(replace_edit("/nodes/Ball/translation", {0.3, 0.8, -0.5}), "m", ".");
      const SceneState again = compiled_again(replayer.state());
      const Image after = preprocessed(again.scene(), kView);
      std::uint64_t affected = 0, rays = 0;
      for_each_pair(before, 1, after, 1, [&](const TreeNode& then, const TreeNode& now) {
        const bool is_affected =
            names(then, state.scene(), "Ball") || !same_tree(then, state.scene(), now, again.scene());
        affected += is_affected ? 1 : 0;
        rays += is_affected ? size_of(now).rays : 0;
      });
      EXPECT_EQ(step.counters.samples_affected, affected);
      EXPECT_LE(step.counters.ray_updates, rays);
      EXPECT_GT(affected, 0U);
      expect_full_frame(replayer);
    }
}

}  // namespace
}  // namespace relook
