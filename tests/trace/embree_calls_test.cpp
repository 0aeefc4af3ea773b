// Ray tests, ray updates, shadow updates and object rays against the number of times that Embree was asked.
#include "embree_calls.h"

#include <gtest/gtest.h>

#include "stored_trees.h"

namespace relook {
namespace {

/// Steps of every kind on scenes of several objects; what moves is one object.
const char* const kEdits[] = {
    R"([{"op": "replace", "path": "/nodes/Ball/translation", "value": [0.3, 0.8, -0.5]}])",
    R"([{"op": "replace", "path": "/nodes/GlassBall/translation", "value": [0.9, 0.7, 0.6]}])",
    R"([{"op": "replace", "path": "/nodes/MirrorBall/extensions/KHR_node_visibility/visible", "value": false}])",
    R"([{"op": "add", "path": "/nodes/New", "value": {"mesh": "GlassBall", "translation": [0.2, 1.9, 0.8],
         "scale": [0.4, 0.4, 0.4]}}])",
    R"([{"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_ior/ior", "value": 1.8}])",
    R"([{"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor",
         "value": 0}])",
    R"([{"op": "replace", "path": "/materials/Matte/pbrMetallicRoughness/baseColorFactor", "value": [0.1, 0.9, 0.1, 1]}])",
    R"([{"op": "replace", "path": "/nodes/Lamp/translation", "value": [1.5, 3.5, 2]}])",
};

/// A fresh replay for each edit, so that the whole scene is one top level and each smaller one is the selection's.
TEST(Embree, is_asked_as_often_as_the_counters_say) {
  std::uint64_t rays = 0, shadows = 0, tests = 0, objects = 0;
  for (const TestScene scene : {TestScene::spheres, TestScene::cards})
    for (const std::uint32_t bits : {0U, 2U})
      for (const std::size_t tunnels : {0U, 1U})
        for (const char* edit : kEdits) {
          SCOPED_TRACE(std::string(test_scene_name(scene)) + ", " + std::to_string(bits) + " bits, " +
                       std::to_string(tunnels) + " tunnels: " + edit);
          EmbreeCallCounter counter;
          RegionOptions options;
          options.tunnels = tunnels;
          Replayer replayer = replayer_of(test_scene(scene, 80, 60), {1, 6, bits}, options);
          (void)counter.take();
          const Counters step = replayer.step(parsed_edit(edit), "e", ".").counters;
          const EmbreeCalls calls = counter.take();
          EXPECT_EQ(step.ray_updates, calls.rays);
          EXPECT_EQ(step.shadow_updates, calls.shadows);
          EXPECT_EQ(step.ray_tests, calls.tests);
          EXPECT_EQ(step.object_rays, calls.objects);
          rays += calls.rays;
          shadows += calls.shadows;
          tests += calls.tests;
          objects += calls.objects;
        }
  EXPECT_GT(rays, 0U);
  EXPECT_GT(shadows, 0U);
  EXPECT_GT(tests, 0U);
  EXPECT_GT(objects, 0U);
}

TEST(Embree, is_asked_for_one_object_as_often_as_object_rays_say) {
  RegionOptions options;
  options.ray_trees = 0;
  options.color_trees = 0;
  EmbreeCallCounter counter;
  Replayer replayer = replayer_of(spheres_scene(80, 60), {1, 6}, options);
  (void)counter.take();
  const Counters step = replayer.step(replace_edit("/lights/Lamp/intensity", 20), "l", ".").counters;
  EXPECT_GT(step.object_rays, 0U);
  EXPECT_EQ(step.object_rays, counter.take().objects);
}

}  // namespace
}  // namespace relook
