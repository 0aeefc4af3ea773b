// What a report says of an edit (its class) is what replay does about it: both follow from one effect of each change.
#include "replay/change.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>

#include "look_fixture.h"
#include "random_changes.h"

namespace relook {
namespace {

/// Is each changed material on an object that was there before and still is?
bool all_are_shown(const RayScene& before, const Scene& after, const SceneDelta& delta) {
  return std::ranges::all_of(delta.materials, [&](const SceneDelta::MaterialChange& change) {
    if (change.id.index() >= before.material_count()) return false;
    return std::ranges::any_of(before.users_of(change.id), [&](ObjectId user) {
      return before.object(user).alive && after.object(user).alive && after.object(user).material == change.id;
    });
  });
}

class ClassOfChange : public testing::TestWithParam<TestScene> {};

TEST_P(ClassOfChange, is_what_replay_does) {
  constexpr std::size_t kEdits = 1000;
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  Dice dice(seed + static_cast<std::uint64_t>(GetParam()));
  SceneState state = small_scene(GetParam(), {1, 5});
  RayScene rays(state.scene());
  std::map<ChangeClass, std::size_t> compared;
  for (std::size_t k = 0; k < kEdits; ++k) {
    const std::vector<Json> edit = random_change(state.document().look, dice).forward;
    const std::vector<LightId> old_lights = state.scene().light_order;
    const SceneDelta delta = apply_edit(state, edit_of_list(edit), "random", ".");
    const ChangeClass stated = classify(state.scene(), delta).change;
    const StepChange done = find_change(rays, state.scene(), delta, old_lights);
    const bool is_shown = all_are_shown(rays, state.scene(), delta);
    rays = rays.after(state.scene(), delta);
    const bool is_stated_geometric = stated == ChangeClass::geometric || stated == ChangeClass::mixed;
    const bool is_done_geometric = done.any_moved || done.rays.lights_changed;
    const std::string what = std::string(change_class_name(stated)) + ": " + Json(edit).dump();
    // What no object shows has a class, too, and nothing is done about it.
    ASSERT_LE(is_done_geometric, is_stated_geometric) << what;
    ASSERT_LE(done.touches_rays(), stated != ChangeClass::color) << what;
    if (!is_shown) continue;
    ASSERT_EQ(is_done_geometric, is_stated_geometric) << what;
    ASSERT_EQ(done.touches_rays(), stated != ChangeClass::color) << what;
    ++compared[stated];
  }
  for (const ChangeClass change : {ChangeClass::color, ChangeClass::optical, ChangeClass::geometric})
    EXPECT_GT(compared[change], kEdits / 50) << change_class_name(change);
}

INSTANTIATE_TEST_SUITE_P(Seeded, ClassOfChange,
                         testing::Values(TestScene::spheres, TestScene::cards, TestScene::study),
                         [](const auto& scene) { return std::string(test_scene_name(scene.param)); });

}  // namespace
}  // namespace relook
