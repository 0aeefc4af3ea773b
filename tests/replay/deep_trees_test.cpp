// Trees of 32 generations between facing mirrors: the branches that lead to a node are told by 28 bits, so that those
// of deep nodes are folded into their parents' (trace/tree/history.h). Edits above, at and below the fold give the
// frames and the trees of a full render, whatever tunnels are built.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "matrix_rows.h"
#include "trace/tree/touch.h"
#include "tree_reader.h"

namespace relook {
namespace {

struct DeepCase {
  std::uint32_t shadow_bits;
  std::size_t tunnels;
  std::uint32_t tunnel_levels;
};

void PrintTo(const DeepCase& c, std::ostream* out) {
  *out << c.shadow_bits << " shadow bits, " << c.tunnels << " tunnels, levels from " << c.tunnel_levels;
}

std::string deep_name(const testing::TestParamInfo<DeepCase>& info) {
  return std::to_string(info.param.shadow_bits) + "_shadow_bits_" + std::to_string(info.param.tunnels) +
         "_tunnels_" + std::to_string(info.param.tunnel_levels) + "_levels";
}

/// A hall of mirrors to the left and to the right, a little out of parallel; within it a dull ball, a glass ball, a
/// veil and a lamp. Rays that see none of them go on between the mirrors to the last generation.
SceneState hall_of_mirrors() {
  SceneBuilder scene;
  const Json silver = {{"pbrMetallicRoughness",
                        {{"baseColorFactor", {0.95, 0.93, 0.9, 1}}, {"metallicFactor", 1}, {"roughnessFactor", 0}}}};
  const Json dull = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.3, 0.2, 1}}, {"metallicFactor", 0}}}};
  Json veil = dull;
  veil["alphaMode"] = "BLEND";
  veil["doubleSided"] = true;
  veil["pbrMetallicRoughness"]["baseColorFactor"] = {0.3, 0.6, 0.9, 0.4};
  Json glass = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}}};
  glass["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  glass["extensions"]["KHR_materials_volume"] = {
      {"thicknessFactor", 1}, {"attenuationDistance", 1}, {"attenuationColor", {0.6, 0.9, 0.7}}};
  const int wall = scene.mesh("Wall", card_mesh(40, 40), scene.material("Mirror", silver));
  const int other = scene.mesh("OtherWall", card_mesh(40, 40), scene.material("OtherMirror", silver));
  scene.node("Left", {{"mesh", wall}, {"translation", {-1.5, 0.5, 0}}, {"rotation", {0, 0.7071068, 0, 0.7071068}}});
  scene.node("Right", {{"mesh", other}, {"translation", {1.5, 0.5, 0}}, {"rotation", {0, -0.7061, 0.001, 0.7081}}});
  scene.node("Ground", {{"mesh", scene.mesh("Ground", plane_mesh(5, 2), scene.material("Ground", dull))},
                        {"translation", {0, -0.8, 0}}});
  scene.node("Ball", {{"mesh", scene.mesh("Ball", sphere_mesh(0.2F, 10, 6), scene.material("Matte", dull))},
                      {"translation", {0.4, -0.5, -0.6}}});
  scene.node("GlassBall", {{"mesh", scene.mesh("GlassBall", sphere_mesh(0.18F, 10, 6), scene.material("Glass", glass))},
                           {"translation", {-0.5, -0.3, -1}}});
  scene.node("Veil", {{"mesh", scene.mesh("Veil", card_mesh(0.3F, 0.3F), scene.material("Veil", veil))},
                      {"translation", {0.1, 0.9, -1.2}}, {"rotation", {0, 0.6, 0, 0.8}}});
  scene.light("Lamp", {{"type", "point"}, {"intensity", 12}}, {{"translation", {0.3, 2, 0.4}}});
  scene.environment({{"color", {0.1, 0.15, 0.2}}});
  scene.look_at(Point(-0.9F, 0.2F, 0.3F), Point(1.5F, 0.25F, 0.1F), 24, 26, 20);
  return scene.state();
}

std::vector<MatrixRow> hall_rows() {
  const char* const visible = "/nodes/Ball/extensions/KHR_node_visibility/visible";
  return {
      row("colour of a mirror", set("/materials/Mirror/pbrMetallicRoughness/baseColorFactor", {0.7, 0.9, 0.95, 1})),
      row("colour of what it shows", set("/materials/Matte/pbrMetallicRoughness/baseColorFactor", {0.2, 0.5, 0.9, 1})),
      row("colour of the light", set("/lights/Lamp/color", {1, 0.7, 0.4})),
      row("tint of the glass",
          set("/materials/Glass/extensions/KHR_materials_volume/attenuationColor", {0.9, 0.5, 0.3})),
      row("coverage of the veil", set("/materials/Veil/pbrMetallicRoughness/baseColorFactor/3", 0.7)),
      row("bend what the glass shows", set("/materials/Glass/extensions/KHR_materials_ior/ior", 1.3)),
      row("a mirror is dull: no tree is deep", set("/materials/OtherMirror/pbrMetallicRoughness/roughnessFactor", 0.8)),
      row("and smooth again", set("/materials/OtherMirror/pbrMetallicRoughness/roughnessFactor", 0.05)),
      row("the ball is a mirror", set("/materials/Matte/pbrMetallicRoughness/metallicFactor", 1),
          set("/materials/Matte/pbrMetallicRoughness/roughnessFactor", 0)),
      row("and dull again", set("/materials/Matte/pbrMetallicRoughness/roughnessFactor", 1)),
      row("move the ball", set("/nodes/Ball/translation", {-0.2, -0.4, -0.3})),
      row("move the glass", set("/nodes/GlassBall/translation", {0.4, -0.2, -0.9})),
      row("hide the ball", set(visible, false)),
      row("show it", set(visible, true)),
      row("move the veil", set("/nodes/Veil/translation", {0.3, 0.6, -0.8})),
      row("add a ball far down the trees", add("/nodes/Twin", {{"mesh", "Ball"}, {"translation", {0.9, 0.2, -3.6}}})),
      row("move it", set("/nodes/Twin/translation", {0.7, 0.1, -4})),
      row("delete it", removed("/nodes/Twin")),
      row("move the lamp", set("/nodes/Lamp/translation", {-0.4, 1.8, -0.6})),
      row("turn a mirror", set("/nodes/Right/rotation", {0, -0.7061, 0.003, 0.7081})),
      row("move a mirror and the ball", set("/nodes/Left/translation", {-1.45, 0.5, 0}),
          set("/nodes/Ball/translation", {0.4, -0.5, -0.6})),
  };
}

/// Generations of the deepest tree, and nodes whose history is that of their parent.
struct Depth {
  std::size_t most = 0, folded = 0;

  void visit(const TreeNode& node, History history, std::size_t generation) {
    most = std::max(most, generation);
    for (const auto& [branch, child] : node.children) {
      folded += history.is_folded() ? 1 : 0;
      visit(child, history.child(branch), generation + 1);
    }
  }
};

class DeepTrees : public testing::TestWithParam<DeepCase> {};

TEST_P(DeepTrees, FoldedHistoriesGiveTheFramesOfFullRenders) {
  const auto [shadow_bits, tunnels, tunnel_levels] = GetParam();
  const ViewOptions view{1, 32, shadow_bits};
  SceneState state = hall_of_mirrors();
  const Image image = preprocessed(state.scene(), view);
  Depth depth;
  for (std::size_t sample = 0; sample < image.frame.pixels.size(); ++sample)
    depth.visit(read_tree(image, 0, sample, state.scene().light_order.size()), History::primary(), 1);
  EXPECT_EQ(depth.most, view.max_depth);
  EXPECT_GT(depth.folded, image.frame.pixels.size());
  expect_full_renders(std::move(state), view, hall_rows(), std::nullopt,
                      {.tunnels = tunnels, .tunnel_levels = tunnel_levels});
}

INSTANTIATE_TEST_SUITE_P(Hall, DeepTrees,
                         testing::Values(DeepCase{0, 1, 2}, DeepCase{0, 0, 2}, DeepCase{0, 2, 0}, DeepCase{2, 1, 2},
                                         DeepCase{2, 2, 0}),
                         deep_name);

}  // namespace
}  // namespace relook
