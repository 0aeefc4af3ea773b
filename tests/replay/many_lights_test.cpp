// Programs tell 6 lights apart (color/surface/node_key.h), words of light states hold 16, sets of lights in tunnels 32,
// those in compressed colour trees 64 (trace/tree/light_set.h): scenes with a light more, and edits of the lights on both sides of each border. After every
// step the replayed frame has the bits of a full render.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "matrix_rows.h"

namespace relook {
namespace {

struct LightsCase {
  int lights;
  std::uint32_t shadow_bits;
};

std::string lights_name(const testing::TestParamInfo<LightsCase>& info) {
  return std::to_string(info.param.lights) + "_lights_" + std::to_string(info.param.shadow_bits) + "_shadow_bits";
}

/// Lights are ordered by the names of their nodes.
std::string light_name(int i) { return std::string(i < 10 ? "L0" : "L") + std::to_string(i); }

/// On a spiral above the scene, so that each of them lights other places and has other blockers.
Json place_of_light(int i, double height) {
  const double turn = 2.4 * i, out = 0.7 + 0.05 * i;
  return {out * std::cos(turn), height + 0.02 * i, out * std::sin(turn)};
}

Json placed_light(const std::string& light, Json translation) {
  return {{"translation", std::move(translation)}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
}

/// A floor, a dull ball, a mirror that sees both, panes that tint light and a slab that blocks it.
SceneState lights_scene(int lights) {
  SceneBuilder scene;
  const Json dull = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.6}}}};
  Json pane = dull;
  pane["doubleSided"] = true;
  pane["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.6, 0.4, 1};
  pane["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  const int matte = scene.material("Matte", dull);
  const int mirror = scene.material("Mirror", {{"pbrMetallicRoughness", {{"roughnessFactor", 0}}}});
  scene.node("Ground", {{"mesh", scene.mesh("Ground", plane_mesh(4, 2), matte)}});
  scene.node("Ball", {{"mesh", scene.mesh("Ball", sphere_mesh(0.5F, 12, 8), matte)}, {"translation", {0.5, 0.5, 0.4}}});
  scene.node("MirrorBall", {{"mesh", scene.mesh("MirrorBall", sphere_mesh(0.5F, 12, 8), mirror)},
                            {"translation", {-0.8, 0.5, -0.3}}});
  scene.node("Pane", {{"mesh", scene.mesh("Pane", plane_mesh(0.8F, 1), scene.material("Pane", pane))},
                      {"translation", {0.6, 1.4, -0.2}}});
  scene.node("Slab", {{"mesh", scene.mesh("Slab", box_mesh(Point(0.5F, 0.05F, 0.4F)), matte)},
                      {"translation", {-0.5, 1.7, 0.5}}});
  for (int i = 0; i < lights; ++i)
    scene.light(light_name(i), {{"type", "point"}, {"intensity", 60.0 / lights}, {"color", {1, 0.5 + 0.007 * i, 0.8}}},
                {{"translation", place_of_light(i, 2.4)}});
  scene.look_at(Point(0.2F, 1.6F, 4.2F), Point(0, 0.5F, 0), 44, 20, 15);
  return scene.state();
}

void add_rows_of_light(int i, int lights, std::vector<MatrixRow>& rows) {
  const std::string name = light_name(i), light = "/lights/" + name, node = "/nodes/" + name;
  const std::string visible = node + "/extensions/KHR_node_visibility/visible";
  rows.push_back(row(name + ": colour", set(light + "/color", {0.2, 1, 0.4})));
  rows.push_back(row(name + ": intensity", set(light + "/intensity", 300.0 / lights)));
  rows.push_back(row(name + ": placement", set(node + "/translation", place_of_light(i + 7, 2.1))));
  rows.push_back(row(name + ": hidden", set(visible, false)));
  rows.push_back(row(name + ": shown", set(visible, true)));
  rows.push_back(row(name + ": deleted", removed(node)));
  rows.push_back(row(name + ": added", add(node, placed_light(name, place_of_light(i + 3, 2.2)))));
}

std::vector<MatrixRow> rows_of_lights(int lights) {
  std::vector<MatrixRow> rows;
  for (const int border : {5, 6, 15, 16, 31, 32, 63, 64})
    if (border < lights) add_rows_of_light(border, lights, rows);
  const std::string last = light_name(lights - 1);
  rows.push_back(row("one more", add("/nodes/M", placed_light(last, {0.3, 3, 1}))));
  rows.push_back(row("one before all others", add("/nodes/A", placed_light(last, {-0.6, 2.6, 1.2}))));
  rows.push_back(row("the one before and the last at once", removed("/nodes/A"), removed("/nodes/" + last)));
  rows.push_back(row("what is lit", set("/materials/Matte/pbrMetallicRoughness/baseColorFactor", {0.4, 0.7, 1, 1})));
  rows.push_back(row("what tints", set("/materials/Pane/pbrMetallicRoughness/baseColorFactor", {0.3, 0.8, 0.5, 1})));
  rows.push_back(row("what blocks", set("/nodes/Slab/translation", {0.2, 1.6, 0.6})));
  rows.push_back(row("no pane", set("/nodes/Pane/extensions/KHR_node_visibility/visible", false)));
  rows.push_back(row("a pane that blocks",
                     set("/materials/Pane/extensions/KHR_materials_transmission/transmissionFactor", 0),
                     set("/nodes/Pane/extensions/KHR_node_visibility/visible", true)));
  return rows;
}

class LightBorders : public testing::TestWithParam<LightsCase> {};

TEST_P(LightBorders, StepsAroundTheBordersOfWordsGiveFullRenders) {
  const auto [lights, shadow_bits] = GetParam();
  SceneState state = lights_scene(lights);
  ASSERT_EQ(state.scene().light_order.size(), static_cast<std::size_t>(lights));
  expect_full_renders(std::move(state), {1, 4, shadow_bits}, rows_of_lights(lights), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(Words, LightBorders,
                         testing::Values(LightsCase{6, 0}, LightsCase{7, 0}, LightsCase{7, 2}, LightsCase{32, 0}, LightsCase{33, 0}, LightsCase{33, 2}, LightsCase{64, 0},
                                         LightsCase{64, 2}, LightsCase{65, 0}, LightsCase{65, 2}),
                         lights_name);

}  // namespace
}  // namespace relook
