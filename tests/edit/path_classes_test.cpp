// The class of an edit under Integrator::path: colours keep every ray, sizes and places shoot those of their light, and
// what may turn a lobe's rays is an upper bound.
#include <gtest/gtest.h>

#include "edit/effect/effect.h"
#include "edit/effect/lobe_effect.h"
#include "look_fixture.h"

namespace relook {
namespace {

/// Two values of one property, and the class of going from either to the other.
struct Row {
  std::string path, first, second;
};

std::string setting(const std::string& path, const std::string& value) {
  const char* const op = path.ends_with("Texture") ? "add" : "replace";
  return std::string(R"([{"op": ")") + op + R"(", "path": ")" + path + R"(", "value": )" + value + "}]";
}

constexpr const char* kRig = R"([
  {"op": "add", "path": "/lights/Window", "value": {"type": "rect"}},
  {"op": "add", "path": "/nodes/Panel", "value": {"extensions": {"EXT_lights_area": {"light": "Window"}}}},
  {"op": "add", "path": "/nodes/Lamp/extras", "value": {"relook": {"excludes": [], "visible": false}}},
  {"op": "add", "path": "/scene/extras/relook/environment/image", "value": "WoodImage"}])";

void expect_class(const Row& row, ChangeClass expected) {
  for (const auto& [before, after] : {std::pair(row.first, row.second), std::pair(row.second, row.first)}) {
    SceneState state = small_state(Integrator::path);
    (void)apply_json(state, kRig);
    (void)apply_json(state, setting(row.path, before));
    const SceneDelta delta = apply_json(state, setting(row.path, after));
    const Classification found = classify(state.scene(), delta);
    EXPECT_EQ(change_class_name(found.change), change_class_name(expected))
        << row.path << ": " << before << " then " << after;
    ASSERT_FALSE(found.reasons.empty()) << row.path;
    for (const std::string& reason : found.reasons) EXPECT_FALSE(reason.ends_with(": ")) << reason;
  }
}

const std::string kGold = "/materials/Gold/", kCoat = kGold + "extensions/KHR_materials_clearcoat/",
                  kSky = "/scene/extras/relook/environment/";

TEST(PathClasses, color_rows) {
  const Row rows[] = {
      {"/lights/Bulb/color", "[1, 1, 1]", "[1, 0, 0]"},
      {"/lights/Bulb/intensity", "30", "3"},
      {"/lights/Bulb/range", "3", "9"},
      {"/lights/Bulb/extras/relook/temperature", "3000", "5000"},
      {"/lights/Window/intensity", "10", "20"},
      {"/nodes/Lamp/extras/relook/excludes", "[]", "[\"Floor\"]"},
      {kSky + "color", "[1, 1, 1]", "[1, 0, 0]"},
      {kSky + "intensity", "1", "2"},
      {kSky + "background", "null", "{\"color\": [1, 0, 0]}"},
      {kSky + "background", "{\"image\": \"BumpImage\"}", "{\"color\": [1, 0, 0]}"},
      {"/lights/Bulb/extras/relook/sum", "\"\"", "\"set\""},
      {"/lights/Bulb/extras/relook/sum", "\"set\"", "\"others\""},
      {kGold + "emissiveFactor", "[0.5, 0, 0]", "[1, 0, 0]"},
      {kGold + "pbrMetallicRoughness/roughnessFactor", "0.52", "0.68"},  // alpha in [1/4, 1/2)
      {kGold + "pbrMetallicRoughness/metallicFactor", "0.3", "0.7"},
      {"/materials/Phong/extras/relook/shininess", "8", "15"},  // in [8, 16)
      {kGold + "pbrMetallicRoughness/baseColorFactor", "[1, 1, 1, 1]", "[0, 0, 1, 1]"},
      {kCoat + "clearcoatFactor", "0.5", "1"},
  };
  for (const Row& row : rows) expect_class(row, ChangeClass::color);
}

TEST(PathClasses, optical_rows) {
  const Row rows[] = {
      {kGold + "pbrMetallicRoughness/roughnessFactor", "0.52", "0.9"},
      {kGold + "pbrMetallicRoughness/metallicFactor", "0", "0.5"},
      {kGold + "pbrMetallicRoughness/metallicFactor", "0.5", "1"},
      {kCoat + "clearcoatFactor", "0", "1"},
      {kGold + "normalTexture", R"({"index": "Bumps", "scale": 0.5})", R"({"index": "Bumps", "scale": 1})"},
      {kGold + "extensions/KHR_materials_ior/ior", "1.5", "1.8"},
      {"/materials/Phong/extras/relook/shininess", "8", "80"},
  };
  for (const Row& row : rows) expect_class(row, ChangeClass::optical);
}

TEST(PathClasses, coverage_turns_rays_where_its_bucket_may_be_another) {
  const std::string base = kGold + "pbrMetallicRoughness/";
  const auto class_of_step = [&](const std::string& before, const std::string& after) {
    SceneState state = small_state(Integrator::path);
    (void)apply_json(state, setting(kGold + "alphaMode", "\"BLEND\""));
    (void)apply_json(state, before);
    return classify(state.scene(), apply_json(state, after)).change;
  };
  const auto alpha = [&](const char* value) {
    return setting(base + "baseColorFactor", "[1, 1, 1, " + std::string(value) + "]");
  };
  EXPECT_EQ(class_of_step(alpha("0.02"), alpha("0.98")), ChangeClass::color);
  EXPECT_EQ(class_of_step(alpha("0.5"), setting(base + "baseColorFactor", "[1, 0, 0, 0.5]")), ChangeClass::color);
  EXPECT_EQ(class_of_step(alpha("0.01"), alpha("0.015")), ChangeClass::color);
  EXPECT_EQ(class_of_step(alpha("0.02"), alpha("0.01")), ChangeClass::optical);
  EXPECT_EQ(class_of_step(alpha("0.98"), alpha("0.99")), ChangeClass::optical);
  EXPECT_EQ(class_of_step(alpha("0.99"), alpha("1")), ChangeClass::optical);
  EXPECT_EQ(class_of_step(alpha("0.01"), alpha("0")), ChangeClass::optical);
}

TEST(PathClasses, vertex_colours_and_texels_widen_the_buckets_of_coverage) {
  Material before, after;
  before.alpha_mode = after.alpha_mode = AlphaMode::blend;
  before.base_color.a = 0.5F;
  after.base_color.a = 0.6F;
  Mesh mesh = square_mesh();
  EXPECT_FALSE(turns_coverage(before, after, mesh));
  mesh.colors.assign(mesh.positions.size(), Rgba(1, 1, 1, 1));
  EXPECT_FALSE(turns_coverage(before, after, mesh));
  mesh.min_alpha = 0.03F;  // 0.015 and 0.018
  EXPECT_TRUE(turns_coverage(before, after, mesh));
  EXPECT_FALSE(turns_coverage(before, before, mesh));
  after.model = before.model = IlluminationModel::blinn_phong;
  after.transparency = before.transparency = 0.5F;
  EXPECT_FALSE(turns_coverage(before, after, mesh)) << "followed beside the surface anyway";
}

TEST(PathClasses, geometric_rows) {
  const Row rows[] = {
      {"/lights/Bulb/extras/relook/radius", "0", "0.1"},
      {"/lights/Bulb/extras/relook/rate", "1", "0.5"},
      {"/lights/Sunlight/extras/relook/angle", "0.01", "0.02"},
      {"/lights/Window/size", "1", "2"},
      {"/lights/Window/rect/aspect", "1", "2"},
      {"/lights/Window/type", "\"rect\"", "\"disk\""},
      {"/lights/Bulb/type", "\"point\"", "\"spot\""},
      {"/nodes/Panel/translation", "[0, 0, 0]", "[1, 0, 0]"},
      {"/nodes/Panel/scale", "[1, 1, 1]", "[2, 2, 2]"},
      {"/nodes/Lamp/extras/relook/visible", "false", "true"},
      {kSky + "rotation", "0", "1"},
      {kSky + "image", "\"WoodImage\"", "\"BumpImage\""},
      {kGold + "emissiveFactor", "[0, 0, 0]", "[1, 0, 0]"},
  };
  for (const Row& row : rows) expect_class(row, ChangeClass::geometric);
}

TEST(PathClasses, an_effect_tells_colour_and_intensity_from_what_is_shaded_again) {
  const Light light;
  Light other = light;
  other.intensity = 2;
  EXPECT_TRUE(effect_of(light, other).recolored);
  EXPECT_FALSE(effect_of(light, other).reshaded);
  other.range = 3;
  EXPECT_TRUE(effect_of(light, other).reshaded);
  other = light;
  other.excluded = {ObjectId(1)};
  EXPECT_TRUE(effect_of(light, other).recolored && effect_of(light, other).reshaded);
}

TEST(PathClasses, whitted_turns_no_lobes) {
  SceneState state = small_state();
  const SceneDelta delta = apply_json(state, setting(kGold + "pbrMetallicRoughness/roughnessFactor", "0.5"));
  EXPECT_EQ(classify(state.scene(), delta).change, ChangeClass::color);
}

}  // namespace
}  // namespace relook
