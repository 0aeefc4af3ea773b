// Table 1 of the paper, row by row: the class of an edit follows from the values before and after, in both directions.
#include <gtest/gtest.h>

#include "look_fixture.h"

namespace relook {
namespace {

/// Two values of one property, and the class of going from either to the other.
struct Row {
  const char* path;
  const char* first;
  const char* second;
};

std::string setting(const char* path, const char* value) {
  return std::string(R"([{"op": "add", "path": ")") + path + R"(", "value": )" + value + "}]";
}

Classification classification_of(const std::string& before, const std::string& edit) {
  SceneState state = small_state();
  (void)apply_json(state, before);
  const SceneDelta delta = apply_json(state, edit);
  return classify(state.scene(), delta);
}

void expect_class(const Row& row, ChangeClass expected) {
  const std::string first = setting(row.path, row.first), second = setting(row.path, row.second);
  for (const auto& [before, after] : {std::pair(first, second), std::pair(second, first)}) {
    const Classification found = classification_of(before, after);
    EXPECT_EQ(change_class_name(found.change), change_class_name(expected)) << before << " then " << after;
    EXPECT_EQ(found.reasons.size(), 1U) << after;
  }
}

constexpr const char* kBumps = R"({"index": "Bumps", "scale": 0.5})";
constexpr const char* kStrongBumps = R"({"index": "Bumps", "scale": 1})";

TEST(Table1, color_rows) {
  const Row rows[] = {
      {"/materials/Gold/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1, 1]", "[0.8, 0.25, 0.05, 1]"},
      {"/materials/Phong/extras/relook/ambient", "[1, 1, 1]", "[0, 0, 1]"},
      {"/materials/Phong/extras/relook/diffuse", "[1, 1, 1]", "[0, 0, 1]"},
      {"/materials/Phong/extras/relook/specular", "[1, 1, 1]", "[0, 0, 1]"},
      {"/materials/Phong/extras/relook/shininess", "8", "80"},
      {"/materials/Gold/pbrMetallicRoughness/roughnessFactor", "0.4", "0.9"},
      {"/materials/Gold/pbrMetallicRoughness/metallicFactor", "0.3", "0.7"},
      {"/materials/Mirror/pbrMetallicRoughness/roughnessFactor", "0", "0.2"},
      {"/materials/Phong/extras/relook/reflection", "0.25", "0.5"},
      {"/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor", "1", "0.5"},
      {"/materials/Glass/extensions/KHR_materials_volume/attenuationColor", "[1, 1, 1]", "[0, 1, 0]"},
      {"/materials/Gold/emissiveFactor", "[0, 0, 0]", "[1, 0, 0]"},
      {"/materials/Gold/extensions/KHR_materials_sheen/sheenColorFactor", "[0, 0, 0]", "[1, 0, 0]"},
      {"/materials/Gold/extensions/KHR_materials_anisotropy/anisotropyStrength", "0", "0.5"},
      {"/materials/Gold/extensions/KHR_materials_anisotropy/anisotropyRotation", "0", "1"},
      {"/materials/Gold/extensions/KHR_materials_iridescence/iridescenceFactor", "0", "1"},
      {"/materials/Gold/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", "400", "500"},
      {"/materials/Gold/extensions/KHR_materials_ior/ior", "1.5", "1.8"},  // nothing is refracted by it
      {"/materials/Gold/extensions/KHR_materials_dispersion/dispersion", "0", "5"},
      {"/materials/Gold/normalTexture", kBumps, kStrongBumps},
      {"/materials/Gold/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale", "[1, 1]",
       "[2, 2]"},
      {"/materials/Gold/pbrMetallicRoughness/baseColorTexture/index", "\"Wood\"", "\"Marble\""},
      {"/lights/Bulb/color", "[1, 1, 1]", "[1, 0, 0]"},
      {"/lights/Bulb/intensity", "30", "3"},
      {"/lights/Bulb/range", "3", "9"},
      {"/scene/extras/relook/ambient", "[0, 0, 0]", "[1, 1, 1]"},
      {"/scene/extras/relook/environment/color", "[0, 0, 0]", "[1, 1, 1]"},
      {"/textures/Marble/extras/relook/procedural/turbulence", "1", "2"},
      {"/textures/Marble/extras/relook/procedural/kind", "\"wood\"", "\"checker\""},
      {"/materials/Gold/extras/relook/model", "\"metallic-roughness\"", "\"unlit\""},
  };
  for (const Row& row : rows) expect_class(row, ChangeClass::color);
}

TEST(Table1, optical_rows) {
  const Row rows[] = {
      {"/materials/Phong/extras/relook/reflection", "0", "0.5"},
      {"/materials/Phong/extras/relook/refraction", "0", "0.5"},
      {"/materials/Phong/extras/relook/transparency", "0", "0.5"},
      {"/materials/Mirror/pbrMetallicRoughness/roughnessFactor", "0.1", "0.9"},
      {"/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor", "0", "0.5"},
      {"/materials/Glass/extensions/KHR_materials_volume/thicknessFactor", "0", "0.5"},
      {"/materials/Glass/extensions/KHR_materials_ior/ior", "1.5", "1.8"},
      {"/materials/Glass/extensions/KHR_materials_dispersion/dispersion", "0", "5"},
      {"/materials/Glass/extensions/KHR_materials_dispersion/dispersion", "5", "2"},
      {"/materials/Mirror/extensions/KHR_materials_clearcoat/clearcoatFactor", "0", "1"},
      {"/materials/Mirror/normalTexture", kBumps, kStrongBumps},
      {"/materials/Glass/normalTexture", kBumps, kStrongBumps},
      {"/materials/Mirror/extras/relook/model", "\"metallic-roughness\"", "\"unlit\""},
  };
  for (const Row& row : rows) expect_class(row, ChangeClass::optical);
}

TEST(Table1, geometric_rows) {
  const Row rows[] = {
      {"/nodes/Sphere/translation", "[0, 0, 0]", "[1, 0, 0]"},
      {"/nodes/Sphere/extensions/KHR_node_visibility/visible", "true", "false"},
      {"/nodes/Sphere/mesh", "\"Ball\"", "\"Pane\""},
      {"/nodes/Lamp/translation", "[0, 0, 0]", "[1, 0, 0]"},
      {"/nodes/Sun/rotation", "[0, 0, 0, 1]", "[1, 0, 0, 0]"},
      {"/nodes/Lamp/extensions/KHR_node_visibility/visible", "true", "false"},
      {"/lights/Bulb/type", "\"point\"", "\"spot\""},
      {"/materials/Gold/doubleSided", "false", "true"},
      {"/nodes/Sphere/extras", "{}", R"({"relook": {"displacement": {"texture": "Bumps"}}})"},
      {"/nodes/Sphere/extras", R"({"relook": {"displacement": {"texture": "Bumps", "scale": 1}}})",
       R"({"relook": {"displacement": {"texture": "Bumps", "scale": 2}}})"},
      {"/nodes/Sphere/extras", R"({"relook": {"displacement": {"texture": "Bumps"}}})",
       R"({"relook": {"displacement": {"texture": "Bumps", "texCoord": 1}}})"},
      {"/nodes/Sphere/extras", R"({"relook": {"displacement": {"texture": "Bumps"}}})",
       R"({"relook": {"displacement": {"texture": "Bumps", "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}}}})"},
  };
  for (const Row& row : rows) expect_class(row, ChangeClass::geometric);
}

TEST(Table1, cut_outs_are_geometric_only_while_they_cut) {
  const Row used{"/materials/Cut/alphaCutoff", "0.5", "0.9"}, unused{"/materials/Gold/alphaCutoff", "0.5", "0.9"};
  EXPECT_EQ(
      classification_of("[]", R"([{"op": "replace", "path": "/meshes/Slab/primitives/0/material", "value": "Cut"}])")
          .change,
      ChangeClass::geometric);
  expect_class(used, ChangeClass::geometric);
  expect_class(unused, ChangeClass::color);
  expect_class({"/materials/Mirror/alphaMode", "\"OPAQUE\"", "\"MASK\""}, ChangeClass::geometric);
  expect_class({"/materials/Cut/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1, 1]", "[1, 1, 1, 0.2]"},
               ChangeClass::geometric);
  expect_class({"/materials/Cut/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1, 1]", "[0, 1, 1, 1]"},
               ChangeClass::color);
}

TEST(Table1, blending_is_optical_when_something_shows_through) {
  EXPECT_EQ(
      classification_of("[]", R"([{"op": "replace", "path": "/materials/Mirror/alphaMode", "value": "BLEND"}])").change,
      ChangeClass::color);
  EXPECT_EQ(classification_of("[]", R"([{"op": "replace", "path": "/materials/Mirror/alphaMode", "value": "BLEND"},
                                        {"op": "replace", "path": "/materials/Mirror/pbrMetallicRoughness/baseColorFactor/3", "value": 0.5}])")
                .change,
            ChangeClass::optical);
}

TEST(Table1, adding_and_deleting_objects_and_lights_is_geometric) {
  for (
      const char* edit :
      {R"([{"op": "remove", "path": "/nodes/Sphere"}])",
       R"([{"op": "add", "path": "/nodes/New", "value": {"mesh": "Ball"}}])",
       R"([{"op": "remove", "path": "/nodes/Sun"}])",
       R"([{"op": "add", "path": "/nodes/New", "value": {"extensions": {"KHR_lights_punctual": {"light": "Bulb"}}}}])"})
    EXPECT_EQ(classification_of("[]", edit).change, ChangeClass::geometric) << edit;
}

TEST(Table1, another_material_counts_as_the_difference_of_the_two) {
  const auto assign = [](const char* material) {
    return setting("/meshes/Slab/primitives/0/material", (std::string("\"") + material + "\"").c_str());
  };
  EXPECT_EQ(classification_of("[]", assign("Glass")).change, ChangeClass::geometric) << "glass has back faces";
  EXPECT_EQ(classification_of(R"([{"op": "replace", "path": "/materials/Glass/doubleSided", "value": false}])",
                              assign("Glass"))
                .change,
            ChangeClass::optical);
  EXPECT_EQ(
      classification_of(assign("Gold"), R"([{"op": "remove", "path": "/meshes/Slab/primitives/0/material"}])").change,
      ChangeClass::color);
}

TEST(Table1, several_changes_take_the_strongest_or_are_mixed) {
  const std::string color = R"({"op": "replace", "path": "/lights/Bulb/intensity", "value": 1})";
  const std::string optical =
      R"({"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_ior/ior", "value": 2})";
  const std::string geometric = R"({"op": "replace", "path": "/nodes/Sphere/translation", "value": [0, 1, 0]})";
  EXPECT_EQ(classification_of("[]", "[]").change, ChangeClass::color);
  EXPECT_EQ(classification_of("[]", "[" + color + "," + optical + "]").change, ChangeClass::optical);
  EXPECT_EQ(classification_of("[]", "[" + color + "," + geometric + "]").change, ChangeClass::geometric);
  EXPECT_EQ(classification_of("[]", "[" + optical + "," + geometric + "]").change, ChangeClass::mixed);
}

TEST(Table1, what_changes_nothing_has_no_reason) {
  const Classification same =
      classification_of("[]", R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 30.0}])");
  EXPECT_EQ(same.change, ChangeClass::color);
  EXPECT_TRUE(same.reasons.empty());
}

TEST(Reasons, name_the_entity_and_both_values) {
  const auto reason = [](const char* edit) { return classification_of("[]", edit).reasons.at(0); };
  EXPECT_EQ(reason(R"([{"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_ior/ior", "value": 1.8}])"),
            "material Glass: index of refraction 1.5 -> 1.8");
  EXPECT_EQ(reason(R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 7}])"),
            "light Bulb (node Lamp): intensity 30 -> 7");
  EXPECT_EQ(reason(R"([{"op": "replace", "path": "/nodes/Sphere/translation/0", "value": 7}])"),
            "node Sphere is transformed");
  EXPECT_EQ(reason(R"([{"op": "replace", "path": "/scene/extras/relook/ambient", "value": [1, 0, 0]}])"),
            "ambient light: (0, 0, 0) -> (1, 0, 0)");
}

/// Coverage above 1 in a float texture: neither a mesh without alpha nor one with alpha 0 tells what its own mesh
/// shows.
TEST(Table1, coverage_is_that_of_the_mesh_which_shows_the_material) {
  Scene scene;
  auto assets = std::make_shared<Assets>();
  assets->meshes.emplace_back();
  assets->meshes.back().min_alpha = 0.8F;
  scene.assets = assets;
  auto bright = std::make_shared<TexturePyramid>();
  bright->smallest = bright->largest = Rgba(1, 1, 1, 1.5F);
  Material veil;
  veil.name = "Veil";
  veil.alpha_mode = AlphaMode::blend;
  veil.slot(Slot::base_color).kind = TextureKind::image;
  veil.slot(Slot::base_color).pyramid = bright;
  SceneDelta delta;
  delta.materials.push_back({MaterialId(0), veil});
  veil.base_color.a = 0.8F;  // 1.5 * 0.8 * 0.8 < 1 < 1.5 * 0.8
  scene.materials.push_back(veil);
  Object object;
  object.mesh = MeshId(0);
  object.material = MaterialId(0);
  scene.objects.push_back(object);
  EXPECT_EQ(change_class_name(classify(scene, delta).change), "optical");
}

}  // namespace
}  // namespace relook
