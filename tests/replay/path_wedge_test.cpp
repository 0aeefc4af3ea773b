// Wedges under `path` that go through the buckets of a lobe's width and of metallic, and through what bends rays: each
// value, forth and back, gives the bits of a full render.
#include <gtest/gtest.h>

#include "color/physics_scenes.h"
#include "matrix_rows.h"
#include "path_checks.h"
#include "path_studio.h"

namespace relook {
namespace {

/// Cells that are there, and holes.
Rgba leaf_texel(std::uint32_t x, std::uint32_t y) {
  return Rgba(0.2F, 0.6F, 0.15F, (x / 4 + y / 4) % 2 == 0 ? 1.0F : 0.0F);
}

struct Wedge {
  const char* name;
  const char* pointer;  // below /materials
  std::vector<double> values;
  TestScene scene = TestScene::lights;
};
void PrintTo(const Wedge& wedge, std::ostream* out) { *out << wedge.name << ": " << wedge.pointer; }

/// Alpha is the square: bucket borders at roughness 0.5, 0.354, 0.25, 0.177 and so on.
const std::vector<double> kRoughness = {0.05, 0.1, 0.18, 0.25, 0.36, 0.5, 0.52, 0.71, 1};
const std::vector<double> kShares = {0, 0.01, 0.0156, 0.25, 0.5, 0.98, 0.99, 1};

class PathWedge : public testing::TestWithParam<Wedge> {};

TEST_P(PathWedge, EveryValueGivesAFullRender) {
  const Wedge& wedge = GetParam();
  const std::string pointer = std::string("/materials/") + wedge.pointer;
  ViewOptions view = path_view(3);
  view.diffuse_depth = 1;
  Replayer replayer = path_replayer(test_scene(wedge.scene, 28, 21), view);
  std::vector<double> values = wedge.values;
  values.insert(values.end(), wedge.values.rbegin() + 1, wedge.values.rend());
  std::vector<Frame> frames;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string what = pointer + " = " + std::to_string(values[i]);
    const StepResult step = expect_path_step(replayer, replace_edit(pointer, values[i]), what, {true, i == 0});
    changed += step.changed_pixels.empty() ? 0 : 1;
    frames.push_back(replayer.image().frame);
    const std::size_t mirrored = values.size() - 1 - i;  // where the wedge was before, on its way back
    if (mirrored < i) {
      EXPECT_EQ(pixel_differences(frames[i], frames[mirrored]), "") << what << ", forth and back";
    }
  }
  EXPECT_GT(changed, 3U) << pointer << " bears on the scene";
}

INSTANTIATE_TEST_SUITE_P(
    Values, PathWedge,
    testing::Values(
        Wedge{"roughness_of_metal", "Mirror/pbrMetallicRoughness/roughnessFactor", kRoughness},
        Wedge{"roughness_of_plastic", "Matte/pbrMetallicRoughness/roughnessFactor", kRoughness},
        Wedge{"roughness_with_a_texture", "Coated/pbrMetallicRoughness/roughnessFactor", kRoughness},
        Wedge{"roughness_of_blended", "Veil/pbrMetallicRoughness/roughnessFactor", kRoughness},
        Wedge{"roughness_under_bumps", "Matte/pbrMetallicRoughness/roughnessFactor", kRoughness, TestScene::study},
        Wedge{"roughness_of_glass", "Glass/pbrMetallicRoughness/roughnessFactor", kRoughness},
        Wedge{"roughness_of_a_pane", "Pane/pbrMetallicRoughness/roughnessFactor", kRoughness},
        Wedge{"metallic_of_metal", "Mirror/pbrMetallicRoughness/metallicFactor", kShares},
        Wedge{"metallic_of_plastic", "Matte/pbrMetallicRoughness/metallicFactor", kShares},
        Wedge{"metallic_with_a_texture", "Coated/pbrMetallicRoughness/metallicFactor", kShares},
        Wedge{"coat", "Coated/extensions/KHR_materials_clearcoat/clearcoatFactor", kShares},
        Wedge{"coat_roughness", "Coated/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", kRoughness},
        Wedge{"ior_of_glass", "Glass/extensions/KHR_materials_ior/ior", {1, 1.1, 1.33, 1.5, 1.8, 2.4}},
        Wedge{"ior_of_plastic", "Matte/extensions/KHR_materials_ior/ior", {1, 1.1, 1.33, 1.5, 1.8, 2.4}},
        Wedge{"transmission_of_glass", "Glass/extensions/KHR_materials_transmission/transmissionFactor", kShares},
        Wedge{"transmission_of_a_pane", "Pane/extensions/KHR_materials_transmission/transmissionFactor", kShares},
        Wedge{"specular", "Matte/extensions/KHR_materials_specular/specularFactor", kShares},
        Wedge{"sheen_roughness", "Cloth/extensions/KHR_materials_sheen/sheenRoughnessFactor", kRoughness},
        Wedge{"alpha", "Veil/pbrMetallicRoughness/baseColorFactor/3", kShares},
        Wedge{"alpha_of_cards", "Mirror/pbrMetallicRoughness/baseColorFactor/3", kShares, TestScene::cards},
        Wedge{"bumps", "Coated/normalTexture/scale", {0, 0.2, 0.6, 1, 1.8}},
        Wedge{"shininess", "Phong/extras/relook/shininess", {0, 1, 3, 7.9, 8, 20, 31, 32, 60, 300}},
        Wedge{"reflection", "Phong/extras/relook/reflection", {0, 0.01, 0.3, 0.7, 1}}),
    [](const testing::TestParamInfo<Wedge>& wedge) { return std::string(wedge.param.name); });

TEST(PathCoverageEdits, of_textures_vertex_colours_and_other_models) {
  // A floor and a mirror look at a sheet whose corners cover it differently.
  PathStudio scene;
  const int leaves = scene.texture("Leaves", scene.image("LeafImage", single_level_image(16, leaf_texel)));
  const auto placed = [](int mesh, double x, double y) { return Json{{"mesh", mesh}, {"translation", {x, y, 0}}}; };
  scene.node("Floor", placed(scene.mesh("Floor", plane_mesh(4, 1), scene.material("Floor", lambert(0.6))), 0, 0));
  const int ball = scene.mesh("Ball", sphere_mesh(0.5F, 16, 10), scene.material("Metal", metal(0.2)));
  scene.node("Ball", placed(ball, 0, 0.5));
  Json sheet = lambert(0.7);
  sheet["alphaMode"] = "BLEND";
  sheet["doubleSided"] = true;
  sheet["pbrMetallicRoughness"]["baseColorTexture"]["index"] = leaves;
  Mesh cloth = plane_mesh(1.2F, 1);
  for (const float alpha : {1.0F, 0.0F, 0.5F, 0.99F}) cloth.colors.emplace_back(1, 1, alpha, alpha);
  scene.node("Cloth", placed(scene.mesh("Cloth", cloth, scene.material("Cloth", sheet)), 0.3, 1.3));
  scene.light("Lamp", {{"type", "point"}, {"intensity", 30}}, {{"translation", {1, 3, 1}}});
  scene.environment({{"color", {0.4, 0.5, 0.6}}});
  scene.look_at(Point(0, 1, 4), Point(0, 0.6F, 0), 50, 24, 18);
  const std::string base = "/materials/Cloth/pbrMetallicRoughness/";
  expect_full_renders(
      scene.path_state(), path_view(4),
      {row("thinner", set(base + "baseColorFactor/3", 0.5)),
       row("next to nothing", set(base + "baseColorFactor/3", 0.012)),
       row("whole", set(base + "baseColorFactor/3", 1)), row("a colour", set(base + "baseColorFactor/0", 0.1)),
       row("without a texture", removed(base + "baseColorTexture")),
       row("with it again", add(base + "baseColorTexture", {{"index", "Leaves"}})),
       row("at another scale", set(base + "baseColorTexture/extensions/KHR_texture_transform/scale", {3, 3})),
       row("unlit", add("/materials/Cloth/extras/relook/model", "unlit")),
       row("unlit and thinner", set(base + "baseColorFactor/3", 0.7)),
       row("blinn-phong", add("/materials/Cloth/extras/relook/model", "blinn-phong")),
       row("that lets light through", add("/materials/Cloth/extras/relook/transparency", 0.3)),
       row("and is thinner", set(base + "baseColorFactor/3", 0.4)),
       row("and does not", add("/materials/Cloth/extras/relook/transparency", 0)),
       row("opaque", set("/materials/Cloth/alphaMode", "OPAQUE")),
       row("blended again", set("/materials/Cloth/alphaMode", "BLEND"))},
      std::nullopt);
}

TEST(PathLobes, come_and_go_with_other_edits) {
  const std::string sheen = "/materials/Cloth/extensions/KHR_materials_sheen/sheenColorFactor";
  expect_full_renders(
      lights_scene(28, 21), path_view(4),
      {row("a bump map on a mirror", add("/materials/Mirror/normalTexture", {{"index", "Bumps"}})),
       row("its strength", set("/materials/Mirror/normalTexture/scale", 0.3)),
       row("another image of it", set("/textures/Bumps/source", "SecondBumpImage")),
       row("off again", removed("/materials/Mirror/normalTexture")),
       row("a bump map on plastic", add("/materials/Matte/normalTexture", {{"index", "Bumps"}})),
       row("a roughness texture on it",
           add("/materials/Matte/pbrMetallicRoughness/metallicRoughnessTexture", {{"index", "Rough"}})),
       row("another roughness texture",
           set("/materials/Matte/pbrMetallicRoughness/metallicRoughnessTexture", {{"index", "Picture"}})),
       row("no coat, a light moves", set("/materials/Coated/extensions/KHR_materials_clearcoat/clearcoatFactor", 0),
           set("/nodes/Dish/translation", {-0.6, 1.6, 0.8})),
       row("a coat on plastic", set("/materials/Matte/extensions/KHR_materials_clearcoat/clearcoatFactor", 1)),
       row("no sheen", set(sheen, {0, 0, 0})), row("a sheen again", set(sheen, {0.2, 0.9, 0.4})),
       row("a black metal", set("/materials/Mirror/pbrMetallicRoughness/baseColorFactor", {0, 0, 0, 1})),
       row("and is not", set("/materials/Mirror/pbrMetallicRoughness/baseColorFactor", {0.4, 0.9, 0.9, 1})),
       row("a brush", set("/materials/Mirror/pbrMetallicRoughness/roughnessFactor", 0.5),
           set("/materials/Mirror/extensions/KHR_materials_anisotropy/anisotropyStrength", 0.5)),
       row("rougher along the brush alone, by buckets", set("/materials/Mirror/pbrMetallicRoughness/roughnessFactor", 0.6)),
       row("another brush", set("/materials/Mirror/extensions/KHR_materials_anisotropy/anisotropyStrength", 0.9)),
       row("a coat on a thin pane", set("/materials/Pane/extensions/KHR_materials_clearcoat/clearcoatFactor", 1)),
       row("off again", set("/materials/Pane/extensions/KHR_materials_clearcoat/clearcoatFactor", 0)),
       row("glass is thin", set("/materials/Glass/extensions/KHR_materials_volume/thicknessFactor", 0)),
       row("glass is rough and thick", set("/materials/Glass/extensions/KHR_materials_volume/thicknessFactor", 1),
           set("/materials/Glass/pbrMetallicRoughness/roughnessFactor", 0.4)),
       row("glass is green", set("/materials/Glass/pbrMetallicRoughness/baseColorFactor", {0.3, 0.9, 0.5, 1})),
       row("the veil is of leaves", set("/materials/Veil/pbrMetallicRoughness/baseColorTexture/index", "Leaves")),
       row("the veil is cut", set("/materials/Veil/alphaMode", "MASK")),
       row("the veil is opaque", set("/materials/Veil/alphaMode", "OPAQUE")),
       row("the sign is lit", set("/materials/Sign/extras/relook/model", "metallic-roughness")),
       row("the sign is not", set("/materials/Sign/extras/relook/model", "unlit")),
       row("its picture", set("/textures/Picture/source", "SecondImage"))},
      std::nullopt);
}

TEST(PathLobes, rays_end_after_as_many_generations_as_in_a_full_render) {
  // The ray straight through the veil is a generation where blinn-phong's transparency sends it, and none otherwise.
  const std::string veil = "/materials/Veil/extras/relook/";
  for (const std::uint32_t depth : {2U, 3U}) {
    ViewOptions view = path_view(4);
    view.max_depth = depth;
    expect_full_renders(
        lights_scene(28, 21), view,
        {row("a rough pane", set("/materials/Pane/pbrMetallicRoughness/roughnessFactor", 0.4)),
         row("glass is rough", set("/materials/Glass/pbrMetallicRoughness/roughnessFactor", 0.4)),
         row("another model", add(veil + "model", "blinn-phong")), row("transparent", add(veil + "transparency", 0.5)),
         row("less", set(veil + "transparency", 0.2)), row("not at all", set(veil + "transparency", 0)),
         row("the first model", set(veil + "model", "metallic-roughness"))},
        std::nullopt);
  }
}

}  // namespace
}  // namespace relook
