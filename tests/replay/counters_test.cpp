// Nothing is redone that need not be: what a step counts, against brute-force counts over the ray trees before and
// after.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "image/render.h"
#include "reference_tracer.h"
#include "replay/replay.h"
#include "stored_trees.h"

namespace relook {
namespace {

constexpr ViewOptions kView{1, 6};
constexpr double kSlack = 1e-3;  // of barycentrics and lengths: what rounding may call a touch

Replayer replayer_of(SceneState state) { return replayer_of(std::move(state), kView, {}); }

bool depends_on(const TreeNode& node, const Scene& scene, const std::string& material) {
  const auto made_of_it = [&](std::uint32_t object) {
    return scene.material(scene.objects[object].material).name == material;
  };
  if (node.missed) return false;
  if (made_of_it(node.object)) return true;
  for (const TreeLight& light : node.lights)
    for (const TreeCrossing& filter : light.filters)
      if (made_of_it(filter.object)) return true;
  for (const auto& [branch, child] : node.children)
    if (depends_on(child, scene, material)) return true;
  return false;
}

void expect_no_rays(const Counters& counters) {
  EXPECT_EQ(counters.ray_tests, 0U);
  EXPECT_EQ(counters.ray_updates, 0U);
  EXPECT_EQ(counters.shadow_updates, 0U);
}

TEST(Counters, SegmentsAreTheRaysAndShadowSegmentsOfAllTrees) {
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    const Replayer replayer = replayer_of(test_scene(scene, 80, 60));
    const TreeSize size = size_of(replayer.image(), replayer.state().scene().light_order.size());
    EXPECT_EQ(replayer.segments(), size.rays + size.shadows) << test_scene_name(scene);
  }
}

TEST(Counters, RenderTracesEachSegmentOnce) {
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    const SceneState state = test_scene(scene, 80, 60);
    RenderStats render_stats, preprocess_stats;
    (void)render(state.scene(), kView, render_stats);
    const Image image = preprocess(state.scene(), kView, preprocess_stats);
    const TreeSize size = size_of(image, state.scene().light_order.size());
    for (const RenderStats& stats : {render_stats, preprocess_stats}) {
      EXPECT_EQ(stats.counters.ray_updates, size.rays);
      EXPECT_EQ(stats.counters.shadow_updates, size.shadows);
    }
  }
}

TEST(Counters, ColorStepsShootNothing) {
  Replayer replayer = replayer_of(spheres_scene(80, 60));
  for (const std::string material : {"Matte", "Mirror", "Glass", "Ground"}) {
    const std::uint64_t segments = replayer.segments();
    const std::vector<TreeNode> trees = trees_by_pixel(replayer);
    const StepResult step = replayer.step(
        replace_edit("/materials/" + material + "/pbrMetallicRoughness/baseColorFactor", {0.31, 0.62, 0.17, 1}), "c",
        ".");
    expect_no_rays(step.counters);
    EXPECT_EQ(step.counters.ray_tests_culled, segments);
    EXPECT_EQ(step.counters.samples_total, trees.size());
    EXPECT_GT(step.changed_pixels.size(), 0U);
    EXPECT_LE(step.changed_pixels.size(), step.counters.samples_affected);
    std::size_t dependent = 0;
    for (const TreeNode& tree : trees) dependent += depends_on(tree, replayer.state().scene(), material) ? 1 : 0;
    EXPECT_EQ(step.counters.samples_affected, dependent) << material;
    for (const std::uint32_t pixel : step.changed_pixels.indices(replayer.image().frame.width))
      EXPECT_TRUE(depends_on(trees[pixel], replayer.state().scene(), material)) << material << " at " << pixel;
  }
}

TEST(Counters, AStepThatChangesNothingTouchesNothing) {
  Replayer replayer = replayer_of(spheres_scene(80, 60));
  const Json same = replayer.state().document().look.at("/materials/Matte/pbrMetallicRoughness"_json_pointer);
  const StepResult step = replayer.step(replace_edit("/materials/Matte/pbrMetallicRoughness", same), "n", ".");
  expect_no_rays(step.counters);
  EXPECT_EQ(step.counters.samples_affected, 0U);
  EXPECT_TRUE(step.changed_pixels.empty());
}

TEST(Counters, LightColorReachesOnlySamplesThatSeeTheLight) {
  Replayer replayer = replayer_of(spheres_scene(80, 60));
  const StepResult step = replayer.step(replace_edit("/lights/Lamp/intensity", 20), "l", ".");
  expect_no_rays(step.counters);
  EXPECT_GT(step.changed_pixels.size(), 0U);
}

/// Rays and shadow segments that an optical change of one material leaves to trace: below its nodes, the branches that
/// are new and, where `bends`, the refracted ones. Everything else goes the way it went.
TreeSize below_material(const TreeNode& before, const TreeNode& after, const Scene& scene, const std::string& material,
                        bool bends) {
  TreeSize size;
  if (after.missed) return size;
  const bool changed = scene.material(scene.objects[after.object].material).name == material;
  for (const auto& [branch, child] : after.children) {
    const auto old = std::find_if(before.children.begin(), before.children.end(),
                                  [&, kind = branch](const TreeChild& other) { return other.branch == kind; });
    const bool goes_as_before = old != before.children.end() && !(changed && bends && branch == Branch::refraction);
    size += goes_as_before ? below_material(old->node, child, scene, material, bends) : size_of(child);
  }
  return size;
}

TEST(Counters, OpticalStepsShootTheRaysBelowTheChangedNodes) {
  // None of these changes what passes light, so no shadow segment of another node is touched.
  struct OpticalEdit {
    const char *material, *pointer;
    Json value;
    bool bends = false;
  };
  const std::vector<OpticalEdit> edits = {
      {"Glass", "/materials/Glass/extensions/KHR_materials_ior/ior", 1.8, true},
      {"Matte", "/materials/Matte/pbrMetallicRoughness/roughnessFactor", 0.1},
      {"Matte", "/materials/Matte/pbrMetallicRoughness/roughnessFactor", 0.8},
      {"Ground", "/materials/Ground/extensions/KHR_materials_clearcoat/clearcoatFactor", 0.5},
      {"Mirror", "/materials/Mirror/pbrMetallicRoughness/roughnessFactor", 0.6},
  };
  Replayer replayer = replayer_of(closed_room());
  for (const OpticalEdit& edit : edits) {
    SCOPED_TRACE(edit.pointer);
    const std::vector<TreeNode> before = trees_by_pixel(replayer);
    const StepResult step = replayer.step(replace_edit(edit.pointer, edit.value), "o", ".");
    const Scene& scene = replayer.state().scene();
    EXPECT_EQ(step.classification.change, ChangeClass::optical);
    TreeSize expected;
    const std::vector<TreeNode> after = trees_by_pixel(replayer);
    for (std::size_t pixel = 0; pixel < after.size(); ++pixel)
      expected += below_material(before[pixel], after[pixel], scene, edit.material, edit.bends);
    EXPECT_EQ(step.counters.ray_updates, expected.rays);
    EXPECT_EQ(step.counters.shadow_updates, expected.shadows);
    for (const std::uint32_t pixel : step.changed_pixels.indices(replayer.image().frame.width))
      EXPECT_TRUE(depends_on(before[pixel], scene, edit.material)) << "at " << pixel;
  }
}

/// Triangles of the selection before and after a move.
struct Selection {
  std::set<std::uint32_t> objects;
  std::vector<WorldTriangle> triangles;

  void add(const Scene& scene, const std::string& node) {
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].node != node || !scene.objects[i].alive) continue;
      objects.insert(i);
      for (const WorldTriangle& triangle : world_triangles(scene, i)) triangles.push_back(triangle);
    }
  }
  [[nodiscard]] bool touches(Vec from, Vec to) const {
    for (const WorldTriangle& triangle : triangles) {
      const LineHit hit = intersect(triangle, from, to - from, kSlack);
      if (hit.inside && hit.t > -kSlack && hit.t < 1 + kSlack) return true;
    }
    return false;
  }
};

/// What the oracle allows a geometric step to trace.
struct Allowance {
  std::uint64_t least_rays = 0, most_rays = 0, most_shadows = 0;
  bool touched = false;
};

struct GeometricOracle {
  const Scene& scene;                                               // after the step
  const std::vector<std::vector<WorldTriangle>>& triangles_before;  // by object
  const Selection& selection;

  [[nodiscard]] Vec point_of(const TreeNode& node) const {
    const WorldTriangle& t = triangles_before[node.object][node.hit.primitive];
    return t.a * (1.0 - node.hit.u - node.hit.v) + t.b * double{node.hit.u} + t.c * double{node.hit.v};
  }

  void visit(Vec from, const TreeNode& before, const TreeNode& after, Allowance& allowance) const {
    const Vec here = point_of(before);
    if (selection.objects.contains(before.object) || selection.touches(from, here)) {
      const TreeSize size = size_of(after);
      allowance.touched = true;
      allowance.most_rays += size.rays;
      allowance.most_shadows += size.shadows;
      if (before.object != after.object || before.hit != after.hit) allowance.least_rays += size.rays - 1;
      return;
    }
    for (std::size_t i = 0; i < before.lights.size(); ++i) {
      if (before.lights[i].state == ShadowState::facing_away) continue;
      if (!selection.touches(here, Vec(scene.light(scene.light_order[i]).position))) continue;
      allowance.touched = true;
      ++allowance.most_shadows;
    }
    ASSERT_EQ(before.children.size(), after.children.size());
    for (std::size_t i = 0; i < before.children.size(); ++i)
      visit(here, before.children[i].node, after.children[i].node, allowance);
  }
};

void expect_only_touched_segments_traced(const std::string& node, const char* edit) {
  Replayer replayer = replayer_of(closed_room());
  Selection selection;
  selection.add(replayer.state().scene(), node);
  std::vector<std::vector<WorldTriangle>> triangles;
  for (std::uint32_t i = 0; i < replayer.state().scene().objects.size(); ++i)
    triangles.push_back(world_triangles(replayer.state().scene(), i));
  const std::vector<TreeNode> before = trees_by_pixel(replayer);
  const std::uint64_t segments = replayer.segments();

  const StepResult step = replayer.step(parsed_edit(edit), "g", ".");

  const Scene& scene = replayer.state().scene();
  selection.add(scene, node);
  const std::vector<TreeNode> after = trees_by_pixel(replayer);
  const GeometricOracle oracle{scene, triangles, selection};
  Allowance total;
  std::vector<bool> touched(before.size());
  for (std::size_t pixel = 0; pixel < before.size(); ++pixel) {
    Allowance allowance;
    oracle.visit(Vec(0, 0, 0), before[pixel], after[pixel], allowance);
    total.least_rays += allowance.least_rays;
    total.most_rays += allowance.most_rays;
    total.most_shadows += allowance.most_shadows;
    touched[pixel] = allowance.touched;
    EXPECT_TRUE(allowance.touched || same_tree(before[pixel], scene, after[pixel], scene)) << "at " << pixel;
  }
  EXPECT_GT(step.changed_pixels.size(), 0U);
  EXPECT_GE(step.counters.ray_updates, total.least_rays);
  EXPECT_LE(step.counters.ray_updates, total.most_rays);
  EXPECT_LE(step.counters.shadow_updates, total.most_shadows);
  EXPECT_LT(total.most_rays, segments / 2);  // or the bound would say nothing
  EXPECT_EQ(step.counters.ray_tests + step.counters.ray_tests_culled, segments);
  EXPECT_LE(step.changed_pixels.size(), step.counters.samples_affected);
  EXPECT_LE(step.counters.samples_affected, step.counters.samples_total);
  for (const std::uint32_t pixel : step.changed_pixels.indices(replayer.image().frame.width))
    EXPECT_TRUE(touched[pixel]) << "at " << pixel;
}

TEST(Counters, MovedOpaqueObjectTracesOnlyTouchedSegments) {
  expect_only_touched_segments_traced(
      "Ball", R"([{"op": "replace", "path": "/nodes/Ball/translation", "value": [0.3, 0.8, -0.5]}])");
}
TEST(Counters, MovedMirrorTracesOnlyTouchedSegments) {
  expect_only_touched_segments_traced(
      "MirrorBall", R"([{"op": "replace", "path": "/nodes/MirrorBall/translation", "value": [-1.4, 0.9, 0.1]}])");
}
TEST(Counters, MovedGlassTracesOnlyTouchedSegments) {
  expect_only_touched_segments_traced(
      "GlassBall", R"([{"op": "replace", "path": "/nodes/GlassBall/translation", "value": [1.2, 0.7, 0.6]}])");
}
TEST(Counters, HiddenObjectTracesOnlyTouchedSegments) {
  expect_only_touched_segments_traced(
      "Ball", R"([{"op": "replace", "path": "/nodes/Ball/extensions/KHR_node_visibility/visible", "value": false}])");
}
TEST(Counters, AddedObjectTracesOnlyTouchedSegments) {
  expect_only_touched_segments_traced(
      "New",
      R"([{"op": "add", "path": "/nodes/New", "value": {"mesh": "MirrorBall", "translation": [0.5, 0.4, 1.2], "scale": [0.4, 0.4, 0.4]}}])");
}

TEST(Counters, MovedLightTracesItsShadowSegmentsOnly) {
  Replayer replayer = replayer_of(closed_room());
  const TreeSize before = size_of(replayer.image(), 1);
  const StepResult step = replayer.step(replace_edit("/nodes/Lamp/translation", {1.5, 3.5, 2}), "m", ".");
  const TreeSize after = size_of(replayer.image(), 1);
  EXPECT_EQ(step.counters.ray_updates, 0U);
  EXPECT_EQ(before.rays, after.rays);
  EXPECT_EQ(step.counters.shadow_updates, after.shadows);
}

TEST(Counters, HiddenLightTracesNothing) {
  Replayer replayer = replayer_of(closed_room());
  const StepResult step =
      replayer.step(replace_edit("/nodes/Lamp/extensions/KHR_node_visibility/visible", false), "h", ".");
  EXPECT_EQ(step.counters.ray_updates, 0U);
  EXPECT_EQ(step.counters.shadow_updates, 0U);
  EXPECT_GT(step.changed_pixels.size(), 0U);
}

TEST(Counters, RejectedEditLeavesEverythingAsItWas) {
  Replayer replayer = replayer_of(spheres_scene(40, 30));
  const Frame before = replayer.image().frame;
  const Json look = replayer.state().document().look;
  const Edit edit = parsed_edit(R"([{"op": "replace", "path": "/nodes/Ball/translation", "value": [1, 1, 1]},
                                {"op": "replace", "path": "/materials/Matte/pbrMetallicRoughness/metallicFactor", "value": 7}])");
  EXPECT_THROW(replayer.step(edit, "bad", "."), InputError);
  EXPECT_EQ(replayer.state().document().look, look);
  const StepResult step = replayer.step(replace_edit("/lights/Lamp/intensity", 60), "same", ".");
  EXPECT_TRUE(step.changed_pixels.empty());
  EXPECT_TRUE(different_pixels(replayer.image().frame, before).empty());
}

}  // namespace
}  // namespace relook
