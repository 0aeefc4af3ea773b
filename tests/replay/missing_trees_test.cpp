// Trees that hold nothing and trees that are not kept are two things: steps count what brute force counts over the
// trees before and after, whether hits are kept or found again, and where there are none to keep.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <set>

#include "image/render.h"
#include "random_changes.h"
#include "replay/replay.h"
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
         std::ranges::any_of(node.children, [](const auto& child) { return faces_a_light(child.node); });
}

bool names(const TreeNode& node, const Scene& scene, std::string_view of_node) {
  const auto is_it = [&](std::uint32_t object) { return scene.objects[object].node == of_node; };
  if (node.missed) return false;
  if (is_it(node.object)) return true;
  for (const TreeLight& light : node.lights)
    if (std::ranges::any_of(light.filters, [&](const TreeCrossing& f) { return is_it(f.object); })) return true;
  return std::ranges::any_of(node.children, [&](const auto& child) { return names(child.node, scene, of_node); });
}

void expect_full_frame(const Replayer& replayer) {
  const SceneState again = compiled_again(replayer.state());
  EXPECT_EQ(different_pixels(replayer.image().frame, rendered(again.scene(), replayer.image().view)).size(), 0U);
}

TEST(SkyTiles, AreLeftAloneWhenALightMoves) {
  for (const std::size_t tunnels : {0U, 1U})
    for (const double ray_trees : {1.0, 0.0}) {
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
    for (const double ray_trees : {1.0, 0.0}) {
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

/// Rays against single objects that find the old hits of a tree up to where the refracted rays of a material leave
/// another way.
std::uint64_t object_rays(const TreeNode& before, const TreeNode& after, const Scene& scene,
                          const std::string& material) {
  if (before.missed) return 0;
  std::uint64_t rays = 1;
  for (const TreeLight& light : before.lights) {
    std::set<std::uint32_t> objects;
    for (const TreeCrossing& filter : light.filters) objects.insert(filter.object);
    rays += objects.size();
  }
  const bool bends = scene.material(scene.objects[before.object].material).name == material;
  for (const auto& [branch, child] : before.children) {
    if (bends && branch == Branch::refraction) continue;
    const auto now =
        std::ranges::find_if(after.children, [&, b = branch](const TreeChild& other) { return other.branch == b; });
    if (now != after.children.end()) rays += object_rays(child, now->node, scene, material);
  }
  return rays;
}

TEST(MissingRayTrees, are_traced_below_the_nodes_of_an_optical_edit_only) {
  RegionOptions kept, missing;
  missing.ray_trees = 0;
  Replayer replayer = replayer_of(spheres_scene(80, 60), kept);
  Replayer without = replayer_of(spheres_scene(80, 60), missing);
  for (const double ior : {1.8, 1.2, 1.5}) {
    const Image before = preprocessed(compiled_again(without.state()).scene(), kView);
    const Edit edit = replace_edit("/materials/Glass/extensions/KHR_materials_ior/ior", ior);
    const Counters all = replayer.step(edit, "o", ".").counters, none = without.step(edit, "o", ".").counters;
    const Scene& scene = without.state().scene();
    const Image after = preprocessed(scene, kView);
    std::uint64_t expected = 0, naming = 0, from_the_eye = 0;
    for_each_pair(before, 1, after, 1, [&](const TreeNode& then, const TreeNode& now) {
      if (!names(then, scene, "GlassBall")) return;
      ++naming;
      from_the_eye += size_of(now).rays;
      expected += object_rays(then, now, scene, "Glass");
    });
    EXPECT_EQ(all.object_rays, 0U);
    EXPECT_EQ(none.object_rays, expected);
    EXPECT_EQ(none.rebuilt.ray_trees, naming);
    EXPECT_EQ(none.ray_updates, all.ray_updates);
    EXPECT_EQ(none.shadow_updates, all.shadow_updates);
    EXPECT_LT(none.ray_updates, from_the_eye - naming);
    EXPECT_EQ(without.resident().ray_trees, 0U);
    expect_full_frame(without);
  }
}

void expect_same_work(const StepResult& with, const StepResult& without, std::uint32_t width) {
  const Counters &a = with.counters, &b = without.counters;
  EXPECT_EQ(a.ray_updates, b.ray_updates);
  EXPECT_EQ(a.shadow_updates, b.shadow_updates);
  EXPECT_EQ(a.ray_tests, b.ray_tests);
  EXPECT_EQ(a.samples_affected, b.samples_affected);
  EXPECT_EQ(a.rebuilt.ray_trees, 0U);
  EXPECT_EQ(with.changed_pixels.indices(width), without.changed_pixels.indices(width));
}

/// Whatever is edited: what is traced against the whole scene does not depend on what is kept.
TEST(MissingRayTrees, change_no_ray_update_of_any_edit) {
  constexpr std::size_t kSteps = 40;
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  std::uint64_t found = 0, traced = 0;
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study})
    for (const std::uint32_t bits : {0U, 2U}) {
      Dice dice(seed + 3 * bits + static_cast<std::uint64_t>(scene));
      RegionOptions options;
      options.tunnels = dice.below(2);
      Replayer with = replayer_of(scene, {1, 5, bits}, options);
      options.ray_trees = 0;
      Replayer without = replayer_of(scene, {1, 5, bits}, options);
      const std::uint32_t width = with.image().frame.width;
      for (std::size_t k = 1; k <= kSteps; ++k) {
        const bool is_drag = dice.chance(0.2);
        const Json& look = with.state().document().look;
        const Change change = is_drag ? random_movement(look, "Ball", dice) : random_change(look, dice);
        const Edit edit = edit_of_list(change.forward);
        SCOPED_TRACE(std::string(test_scene_name(scene)) + ", step " + std::to_string(k) + ": " +
                     Json(change.forward).dump());
        const auto step = [&](Replayer& r) {
          return is_drag ? r.drag(edit, "random", ".") : r.step(edit, "random", ".");
        };
        const StepResult a = step(with), b = step(without);
        expect_same_work(a, b, width);
        if (is_drag) expect_same_work(with.release(), without.release(), width);
        ASSERT_EQ(different_pixels(with.image().frame, without.image().frame).size(), 0U);
        expect_full_frame(without);
        if (HasFailure()) return;
        found += b.counters.object_rays;
        traced += b.counters.ray_updates;
      }
    }
  EXPECT_GT(found, 0U);
  EXPECT_GT(traced, 0U);
}

}  // namespace
}  // namespace relook
