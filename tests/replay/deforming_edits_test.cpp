// Edits that deform meshes: after each the replayed frame has the bits of a full render of the edited scene, and the
// ray trees are those that a fresh preprocess finds.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "image/render.h"
#include "matrix_rows.h"
#include "random_changes.h"

namespace relook {
namespace {

/// Morph weights and joints bend what is seen directly, in a mirror, through glass and in shadows.
std::vector<MatrixRow> deforming_rows() {
  const Json identity = Json::array({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.3, 0, 1});
  return {
      row("a morph weight", set("/nodes/MirrorBall/weights/0", 0.8)),
      row("all weights", set("/nodes/GlassBall/weights", {0.3, -0.5})),
      row("weight of a skinned mesh", set("/nodes/Ball/weights/1", 0.7)),
      row("weight of a displaced mesh", set("/nodes/Post/weights/0", 0.5)),
      row("no weights: those of the mesh", removed("/nodes/MirrorBall/weights")),
      row("weights of the mesh", set("/meshes/MirrorBall/weights/1", 0.4)),
      row("turn a joint", set("/nodes/Chest/rotation", {0, 0, 0.38268343, 0.92387953})),
      row("move the root of the joints", set("/nodes/Hip/translation", {0.3, 0.4, -0.2})),
      row("what holds the joints", set("/nodes/Rig/rotation", {0, 0.5, 0, 0.8660254})),
      row("mirror a joint", set("/nodes/Chest/scale", {-1, 1, 1})),
      row("flatten a joint", set("/nodes/Chest/scale", {1, 0, 1})),
      row("a joint and a weight at once", set("/nodes/Chest/scale", {1.2, 0.8, 1}), set("/nodes/Ball/weights/0", 0.6)),
      row("a second puppet", add("/nodes/Twin", {{"mesh", "Ball"}, {"skin", "Puppet"}, {"weights", {0, -0.4}}})),
      row("without its skin", removed("/nodes/Twin/skin"), set("/nodes/Twin/translation", {1.4, 0.6, -0.9})),
      row("with it again", add("/nodes/Twin/skin", "Puppet")),
      row("another joint name", Json{{"op", "move"}, {"from", "/nodes/Chest"}, {"path", "/nodes/Thorax"}}),
      row("turn it by that name", set("/nodes/Thorax/rotation", {0, 0, -0.258819, 0.9659258})),
      row("hang a joint elsewhere", set("/nodes/Hip/children", Json::array()), add("/nodes/Rig/children/-", "Thorax")),
      row("a joint's matrix", set("/nodes/Thorax", {{"matrix", identity}})),
      row("hide the mesh", set("/nodes/Ball/extensions/KHR_node_visibility/visible", false)),
      row("move joints of a hidden mesh", set("/nodes/Hip/translation", {-0.2, 0.5, -0.3})),
      row("show it", set("/nodes/Ball/extensions/KHR_node_visibility/visible", true)),
      row("another mesh", set("/nodes/Ball/mesh", "MirrorBall")),
      row("a transform that counts for nothing", set("/nodes/Twin/translation", {0, 9, 0})),
  };
}

std::string view_name(const testing::TestParamInfo<ViewOptions>& view) {
  return std::to_string(view.param.samples) + "_samples_" + std::to_string(view.param.shadow_bits) + "_shadow_bits";
}

class DeformingViews : public testing::TestWithParam<ViewOptions> {};

TEST_P(DeformingViews, ReplayedFramesAndTreesAreThoseOfAFullRender) {
  const ViewOptions view = GetParam();
  const std::uint32_t size = view.samples == 1 ? 1 : 2;
  expect_full_renders(puppet_scene(88 / size, 66 / size), view, deforming_rows(), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(DeformingEdits, DeformingViews,
                         testing::Values(ViewOptions{1, 6, 0}, ViewOptions{1, 5, 2}, ViewOptions{4, 4, 0}), view_name);

/// The paper's drag: the selection is out of the ray trees until it is released.
TEST(DeformingEdits, ADraggedSkeletonLeavesTheFramesOfFullRenders) {
  const ViewOptions view{1, 5, 0};
  SceneState state = puppet_scene(88, 66);
  Image image = preprocessed(state.scene(), view);
  Replayer replayer(std::move(state), std::move(image));
  for (int i = 1; i <= 5; ++i) {
    const double angle = 0.2 * i;
    replayer.drag(edit_of(Json::array({set("/nodes/Chest/rotation", {0, 0, std::sin(angle), std::cos(angle)}),
                                       set("/nodes/MirrorBall/weights/0", 0.15 * i)})),
                  "drag", ".");
    const SceneState again = compiled_again(replayer.state());
    EXPECT_EQ(different_pixels(replayer.image().frame, rendered(again.scene(), view)).size(), 0U) << i;
  }
  replayer.release();
  expect_fresh_image(replayer);
}

TEST(DeformingEdits, RandomWeightsAndJointsGiveTheFramesOfFullRenders) {
  const std::uint64_t seed = seed_of_run();
  SCOPED_TRACE("RELOOK_SEED=" + std::to_string(seed));
  Dice dice(seed);
  const ViewOptions view{1, 5, 1};
  SceneState state = puppet_scene(60, 45);
  Image image = preprocessed(state.scene(), view);
  Replayer replayer(std::move(state), std::move(image));
  for (int i = 0; i < 25; ++i) {
    const Json random = random_deformation(dice);
    SCOPED_TRACE(random.dump());
    replayer.step(edit_of(random), "random", ".");
    expect_fresh_image(replayer);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace relook
