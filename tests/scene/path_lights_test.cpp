// Lights under Integrator::path: what the look document says of them reaches the scene, suns and emission are lights,
// and following an edit gives the same as starting afresh. Under Integrator::whitted nothing of it is there.
#include <gtest/gtest.h>

#include "look_fixture.h"
#include "scene/compile/place_light.h"
#include "scene/light_sums.h"
#include "scene/look/look_warnings.h"

namespace relook {
namespace {

constexpr const char* kArea = R"([
  {"op": "add", "path": "/lights/Window", "value": {"type": "rect", "size": 2, "rect": {"aspect": 3}}},
  {"op": "add", "path": "/nodes/Panel", "value": {"translation": [0, 4, 0], "scale": [1, -5, 0.5],
    "extensions": {"EXT_lights_area": {"light": "Window"}}}}])";

std::string setting(const std::string& path, const std::string& value) {
  return R"([{"op": "replace", "path": ")" + path + R"(", "value": )" + value + "}]";
}

const Light& light_of(const Scene& scene, std::string_view node) {
  for (const Light& light : scene.lights)
    if (light.node == node && traits_of(light.kind).in_document) return light;
  throw std::out_of_range("no such light");
}
const Light& only(const Scene& scene, LightKind kind) {
  for (const Light& light : scene.lights)
    if (light.kind == kind) return light;
  throw std::out_of_range("no such light");
}

/// The scene after an edit is the one that its document compiles to.
void expect_fresh(const SceneState& state) {
  LookDocument copy = state.document();
  const SceneState fresh(std::move(copy), state.scene().camera, state.pyramids(), state.scene().integrator);
  EXPECT_EQ(scene_text(state.scene()), scene_text(fresh.scene()));
}

TEST(PathLights, areas_have_the_largest_scale_of_their_node_whatever_its_sign) {
  SceneState state = small_state(Integrator::path);
  const SceneDelta delta = apply_json(state, kArea);
  ASSERT_EQ(delta.lights.size(), 1U);
  const Light& light = light_of(state.scene(), "Panel");
  EXPECT_EQ(light.kind, LightKind::rect);
  EXPECT_EQ(light.intensity, 1000);
  EXPECT_EQ(light.position, Point(0, 4, 0));
  EXPECT_EQ(light.direction, Direction(0, 0, -1));
  EXPECT_EQ(light.right, Direction(15, 0, 0));
  EXPECT_EQ(light.up, Direction(0, 5, 0));
  expect_fresh(state);
}

TEST(PathLights, areas_on_flat_nodes_keep_their_axes_and_on_nothing_give_no_light) {
  for (const char* scale : {"[1, 1, 0]", "[0, 1, 1]", "[1, 0, 1]", "[0, 0, 1]", "[-1, -1, -1]"}) {
    SceneState state = small_state(Integrator::path);
    (void)apply_json(state, kArea);
    (void)apply_json(state, setting("/nodes/Panel/scale", scale));
    const Light& light = light_of(state.scene(), "Panel");
    EXPECT_TRUE(light.alive) << scale;
    EXPECT_NEAR(light.right.length(), 3, 1e-6) << scale;
    EXPECT_NEAR(light.up.length(), 1, 1e-6) << scale;
    EXPECT_EQ(light.right.dot(light.direction), 0) << scale;
    EXPECT_GT(light.up.dot(light.right.cross(light.direction)), 0) << scale;
  }
  SceneState state = small_state(Integrator::path);
  (void)apply_json(state, kArea);
  (void)apply_json(state, setting("/nodes/Panel/scale", "[0, 0, 0]"));
  EXPECT_FALSE(light_of(state.scene(), "Panel").alive);
}

TEST(PathLights, soft_lamps_have_a_radius_or_an_angle_each_of_its_own_kind) {
  SceneState state = small_state(Integrator::path);
  EXPECT_EQ(apply_json(state, setting("/lights/Bulb/extras/relook/radius", "0.25")).lights.size(), 1U);
  EXPECT_EQ(apply_json(state, setting("/lights/Sunlight/extras/relook/angle", "0.01")).lights.size(), 1U);
  EXPECT_TRUE(apply_json(state, setting("/lights/Sunlight/extras/relook/radius", "1")).empty());
  EXPECT_EQ(apply_json(state, setting("/lights/Bulb/extras/relook/rate", "0.5")).lights.size(), 1U);
  EXPECT_EQ(light_of(state.scene(), "Lamp").radius, 0.25F);
  EXPECT_EQ(light_of(state.scene(), "Lamp").rate, 0.5F);
  EXPECT_EQ(light_of(state.scene(), "Sun").angle, 0.01F);
  expect_fresh(state);
}

TEST(PathLights, bounds_are_named) {
  const std::pair<const char*, const char*> wrong[] = {
      {"radius", "-1"}, {"angle", "3.2"}, {"rate", "0"}, {"rate", "1.5"}, {"temperature", "500"}};
  for (const auto& [key, value] : wrong) {
    SceneState state = small_state(Integrator::path);
    const std::string message =
        message_of([&] { (void)apply_json(state, setting(std::string("/lights/Bulb/extras/relook/") + key, value)); });
    EXPECT_NE(message.find(value), std::string::npos) << key << ": " << message;
  }
}

TEST(PathLights, a_temperature_is_a_colour_of_luminance_one) {
  for (const double kelvin : {1000.0, 2856.0, 5000.0, 6504.0, 40000.0}) {
    const Color color = temperature_color(kelvin);
    EXPECT_NEAR(0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z, 1, 1e-6) << kelvin;
  }
  // CIE 015 has illuminant A, a black body at 2856 K, at x = 0.44758, y = 0.40745: the chromaticity goes to sRGB.
  const Color warm = temperature_color(2856);
  EXPECT_NEAR(warm.x / warm.y, 2.233, 0.03);
  EXPECT_NEAR(warm.z / warm.y, 0.282, 0.01);
  const Color day = temperature_color(6504);
  EXPECT_NEAR(day.x, 1, 0.06);
  EXPECT_NEAR(day.z, 1, 0.06);
  SceneState state = small_state();
  (void)apply_json(state, setting("/lights/Bulb/extras/relook/temperature", "2856"));
  EXPECT_EQ(light_of(state.scene(), "Lamp").color, warm);
}

TEST(PathLights, linking_follows_nodes_and_what_hangs_on_them) {
  SceneState state = small_state(Integrator::path);
  (void)apply_json(state, setting("/nodes/Lamp/extras/relook/excludes", R"(["Group", "Floor"])"));
  EXPECT_EQ(light_of(state.scene(), "Lamp").excluded.size(), 4U);  // Sphere, Hand, Floor twice
  for (const ObjectId id : light_of(state.scene(), "Lamp").excluded) {
    EXPECT_TRUE(light_of(state.scene(), "Lamp").excludes(id));
    EXPECT_NE(state.scene().object(id).node, "Window");
  }
  const SceneDelta delta = apply_json(state, setting("/nodes/Arm/children", "[]"));
  EXPECT_EQ(delta.lights.size(), 1U);
  EXPECT_EQ(light_of(state.scene(), "Lamp").excluded.size(), 3U);
  expect_fresh(state);
  (void)apply_json(state, R"([{"op": "move", "from": "/nodes/Floor", "path": "/nodes/Ground"}])");
  EXPECT_EQ(state.document().look["nodes"]["Lamp"]["extras"]["relook"]["excludes"], Json({"Group", "Ground"}));
  EXPECT_EQ(light_of(state.scene(), "Lamp").excluded.size(), 3U);
  expect_fresh(state);
  (void)apply_json(state, R"([{"op": "remove", "path": "/nodes/Lamp/extras/relook/excludes"}])");
  EXPECT_TRUE(light_of(state.scene(), "Lamp").excluded.empty());
}

TEST(PathLights, an_excluded_node_that_is_unknown_or_removed_is_an_error_and_leaves_the_scene) {
  SceneState state = small_state(Integrator::path);
  const std::string before = scene_text(state.scene());
  const std::string unknown =
      message_of([&] { (void)apply_json(state, setting("/nodes/Lamp/extras/relook/excludes", R"(["Flor"])")); });
  EXPECT_NE(unknown.find("no node \"Flor\"; did you mean \"Floor\"?"), std::string::npos) << unknown;
  EXPECT_EQ(scene_text(state.scene()), before);
  (void)apply_json(state, setting("/nodes/Lamp/extras/relook/excludes", R"(["Floor"])"));
  const std::string used =
      message_of([&] { (void)apply_json(state, R"([{"op": "remove", "path": "/nodes/Floor"}])"); });
  EXPECT_NE(used.find("node \"Floor\" is still used by"), std::string::npos) << used;
  expect_fresh(state);
}

TEST(PathLights, a_node_has_one_light) {
  SceneState state = small_state(Integrator::path);
  const std::string message = message_of(
      [&] { (void)apply_json(state, setting("/nodes/Lamp/extensions", R"({"KHR_lights_punctual": {"light": "Bulb"},
        "EXT_lights_area": {"light": "Bulb"}})")); });
  EXPECT_NE(message.find("a node has one light"), std::string::npos) << message;
}

TEST(PathLights, suns_are_the_environment_s_and_a_light_that_always_lives) {
  SceneState state = small_state(Integrator::path);
  EXPECT_TRUE(only(state.scene(), LightKind::suns).alive);
  EXPECT_EQ(only(state.scene(), LightKind::suns).image, nullptr);
  const SceneDelta turned = apply_json(state, setting("/scene/extras/relook/environment/rotation", "1"));
  EXPECT_TRUE(turned.lights.empty());  // nothing is there to turn
  const SceneDelta delta = apply_json(
      state, R"([{"op": "add", "path": "/scene/extras/relook/environment/image", "value": "WoodImage"}])");
  ASSERT_EQ(delta.lights.size(), 1U);
  EXPECT_EQ(delta.lights[0].before.kind, LightKind::suns);
  const Light& suns = only(state.scene(), LightKind::suns);
  EXPECT_EQ(suns.color, Color(1, 1, 1));  // an image without a colour stands as it is
  EXPECT_EQ(suns.rotation, 1);
  EXPECT_EQ(suns.image, state.scene().environment.image);
  expect_fresh(state);
}

TEST(PathLights, emission_lives_while_it_is_not_black) {
  SceneState state = small_state(Integrator::path);
  const std::size_t lights = state.scene().light_order.size();
  const SceneDelta born = apply_json(state, setting("/materials/Gold/emissiveFactor", "[1, 0.5, 0]"));
  ASSERT_EQ(born.lights.size(), 1U);
  EXPECT_FALSE(born.lights[0].before.alive);
  const Light& light = only(state.scene(), LightKind::emission);
  EXPECT_EQ(light.light, "Gold");
  EXPECT_EQ(light.color, Color(1, 0.5F, 0));
  EXPECT_EQ(state.scene().material(light.material).name, "Gold");
  EXPECT_EQ(state.scene().light(state.scene().light_order.back()), light);
  (void)apply_json(state,
                   setting("/materials/Gold/extensions/KHR_materials_emissive_strength/emissiveStrength", "7"));
  EXPECT_EQ(only(state.scene(), LightKind::emission).intensity, 7);
  (void)apply_json(
      state, R"([{"op": "add", "path": "/materials/Gold/emissiveTexture", "value": {"index": "Bumps"}}])");
  EXPECT_EQ(only(state.scene(), LightKind::emission).emission.kind, TextureKind::image);
  expect_fresh(state);
  const SceneDelta unlit = apply_json(state, setting("/materials/Gold/extras/relook/model", "\"unlit\""));
  EXPECT_EQ(unlit.lights.size(), 1U);
  EXPECT_EQ(state.scene().light_order.size(), lights);
  expect_fresh(state);
}

TEST(PathLights, slots_that_a_refused_or_undone_edit_made_are_gone) {
  SceneState state = small_state(Integrator::path);
  const std::string before = scene_text(state.scene());
  const std::size_t slots = state.scene().lights.size();
  const std::string message = message_of([&] {
    (void)apply_json(state, R"([{"op": "replace", "path": "/materials/Gold/emissiveFactor", "value": [1, 1, 1]},
                                {"op": "replace", "path": "/nodes/Rig/translation", "value": [0, 0, 0]}])");
  });
  EXPECT_NE(message.find("active camera"), std::string::npos) << message;
  EXPECT_EQ(state.scene().lights.size(), slots);
  EXPECT_EQ(scene_text(state.scene()), before);
  const SlotCounts counts = state.slot_counts();
  (void)apply_json(state, setting("/materials/Gold/emissiveFactor", "[1, 1, 1]"));
  (void)apply_json(state, setting("/materials/Gold/emissiveFactor", "[0, 0, 0]"));
  state.drop_slots_after(counts);
  (void)apply_json(state, setting("/materials/Gold/emissiveFactor", "[1, 1, 1]"));
  EXPECT_EQ(state.scene().lights.size(), slots + 1);
  expect_fresh(state);
}

TEST(PathLights, sums_are_the_lights_with_the_sky_before_the_suns_and_four_without_rays) {
  SceneState state = small_state(Integrator::path);
  (void)apply_json(state, setting("/materials/Gold/emissiveFactor", "[1, 0, 0]"));
  (void)apply_json(state, R"([{"op": "move", "from": "/nodes/Lamp", "path": "/nodes/a.b"}])");
  (void)apply_json(state, setting("/scene/extras/relook/environment/background",
                                  R"({"color": [0.5, 0.25, 0], "intensity": 2})"));
  std::vector<std::string> names;
  for (const LightSum& sum : light_sums(state.scene())) names.push_back(sum.name);
  EXPECT_EQ(names, (std::vector<std::string>{"light_Sun", "light_a_b", "sky", "suns", "emission_Gold", "ambient",
                                             "background", "unlit"}));
  EXPECT_EQ(light_sums(state.scene())[1].color, (std::array<double, 3>{30, 30, 30}));
  EXPECT_EQ(light_sums(state.scene())[6].color, (std::array<double, 3>{1, 0.5, 0}));
  (void)apply_json(state, setting("/scene/extras/relook/environment/background", "null"));
  EXPECT_FALSE(state.scene().environment.background);
  expect_fresh(state);
}

TEST(PathLights, whitted_has_nothing_of_it) {
  SceneState state = small_state();
  const std::string before = scene_text(state.scene());
  EXPECT_TRUE(apply_json(state, kArea).empty());
  for (const auto& [path, value] : std::initializer_list<std::pair<const char*, const char*>>{
           {"/lights/Bulb/extras/relook/radius", "1"},
           {"/lights/Bulb/extras/relook/rate", "0.5"},
           {"/lights/Bulb/extras/relook/sum", "\"set\""},
           {"/nodes/Lamp/extras/relook/excludes", "[\"Floor\"]"},
           {"/nodes/Lamp/extras/relook/visible", "true"},
           {"/scene/extras/relook/environment/background", "{\"color\": [1, 1, 1]}"}})
    EXPECT_TRUE(apply_json(state, setting(path, value)).empty()) << path;
  EXPECT_TRUE(apply_json(state, setting("/materials/Gold/emissiveFactor", "[1, 1, 1]")).lights.empty());
  EXPECT_EQ(state.scene().light_order.size(), 2U);
  (void)apply_json(state, setting("/materials/Gold/emissiveFactor", "[0, 0, 0]"));
  EXPECT_EQ(scene_text(state.scene()), before);
  const std::vector<std::string> warnings = look_warnings(state.document());
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0], "light \"Window\" has an area: it gives light only with --integrator path");
  EXPECT_EQ(warnings[1], "light \"Bulb\" has a radius or an angle: its shadows are soft only with --integrator path");
  EXPECT_TRUE(look_warnings(state.document(), Integrator::path).empty());
}

TEST(PathLights, automatic_lights_come_with_an_environment_where_there_is_none) {
  LookDocument document = make_look_document(small_gltf());
  const Camera camera = choose_camera(document, "Lens", 64, 48);
  LookDocument whitted = document;
  (void)add_auto_lights(whitted, camera);
  EXPECT_FALSE(whitted.look["scene"]["extras"]["relook"]["environment"].contains("color"));
  LookDocument given = document;
  given.look["scene"]["extras"]["relook"]["environment"]["color"] = {0.1, 0.2, 0.3};
  (void)add_auto_lights(given, camera, Integrator::path);
  EXPECT_EQ(given.look["scene"]["extras"]["relook"]["environment"]["color"], Json({0.1, 0.2, 0.3}));
  (void)add_auto_lights(document, camera, Integrator::path);
  EXPECT_GT(document.look["scene"]["extras"]["relook"]["environment"]["color"][0], 0.2);
  EXPECT_EQ(document.look["lights"].size(), 6U);
}

TEST(PathLights, automatic_lights_are_discs_for_paths_alone) {
  LookDocument document = make_look_document(small_gltf());
  const Camera camera = choose_camera(document, "Lens", 64, 48);
  LookDocument whitted = document;
  (void)add_auto_lights(whitted, camera);
  (void)add_auto_lights(document, camera, Integrator::path);
  for (const char* name : {"key", "fill", "rim"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(whitted.look["lights"][name].value("/extras/relook/angle"_json_pointer, 0.0), 0.0);
    EXPECT_GT(document.look["lights"][name]["extras"]["relook"]["angle"], 0.1);
    EXPECT_EQ(document.look["lights"][name]["intensity"], whitted.look["lights"][name]["intensity"]);
  }
}

}  // namespace
}  // namespace relook
