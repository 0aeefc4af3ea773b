// What is said of pointers that lead nowhere and of values in other units: the place that is meant, in full.
#include "edit/guide/path_hints.h"

#include <gtest/gtest.h>

#include "refusal.h"

namespace relook {
namespace {

/// What a replace of a path is refused with, behind its place.
std::string said_of(const std::string& path) {
  const std::string message = refusal(R"([{"op": "replace", "path": ")" + path + R"(", "value": 1}])");
  const std::string prefix = "/edit/0/path: ";
  return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

TEST(PathHints, a_key_that_stands_deeper_is_named_in_full) {
  EXPECT_EQ(said_of("/materials/Gold/roughnessFactor"),
            "no \"roughnessFactor\" in /materials/Gold; did you mean "
            "/materials/Gold/pbrMetallicRoughness/roughnessFactor?");
  EXPECT_EQ(said_of("/materials/Gold/ior"),
            "no \"ior\" in /materials/Gold; did you mean /materials/Gold/extensions/KHR_materials_ior/ior?");
  EXPECT_EQ(said_of("/materials/Gold/pbrMetallicRoughness/ior"),
            "no \"ior\" in /materials/Gold/pbrMetallicRoughness; did you mean "
            "/materials/Gold/extensions/KHR_materials_ior/ior?");
  EXPECT_EQ(said_of("/nodes/Sphere/visible"),
            "no \"visible\" in /nodes/Sphere; did you mean /nodes/Sphere/extensions/KHR_node_visibility/visible?");
  EXPECT_EQ(said_of("/scene/environment/intensity"),
            "no \"environment\" in /scene; did you mean /scene/extras/relook/environment/intensity?");
}

TEST(PathHints, words_of_other_programs_and_british_spelling_are_known) {
  EXPECT_EQ(said_of("/materials/Gold/color/0"),
            "no \"color\" in /materials/Gold; did you mean /materials/Gold/pbrMetallicRoughness/baseColorFactor/0?");
  EXPECT_EQ(said_of("/materials/Gold/pbrMetallicRoughness/baseColourFactor"),
            "no \"baseColourFactor\" in /materials/Gold/pbrMetallicRoughness; did you mean "
            "/materials/Gold/pbrMetallicRoughness/baseColorFactor?");
  EXPECT_EQ(said_of("/lights/Bulb/colour"), "no \"colour\" in /lights/Bulb; did you mean /lights/Bulb/color?");
  EXPECT_EQ(said_of("/lights/Bulb/power"), "no \"power\" in /lights/Bulb; did you mean /lights/Bulb/intensity?");
  EXPECT_EQ(said_of("/nodes/Sphere/position"),
            "no \"position\" in /nodes/Sphere; did you mean /nodes/Sphere/translation?");
  EXPECT_EQ(said_of("/world/rotation"), "no \"world\"; did you mean /scene/extras/relook/environment/rotation?");
}

TEST(PathHints, sections_and_entities_of_other_sections_are_found) {
  EXPECT_EQ(said_of("/light/Bulb/intensity"), "no \"light\"; did you mean /lights/Bulb/intensity?");
  EXPECT_EQ(said_of("/Gold/roughness"),
            "no \"Gold\"; did you mean /materials/Gold/pbrMetallicRoughness/roughnessFactor?");
  EXPECT_EQ(said_of("/lights/Lamp/intensity"), "no \"Lamp\" in /lights; did you mean /lights/Bulb/intensity?");
  EXPECT_EQ(said_of("/nodes/Lamp/intensity"), "no \"intensity\" in /nodes/Lamp; did you mean /lights/Bulb/intensity?");
  EXPECT_EQ(said_of("/lights/Bulb/translation"),
            "no \"translation\" in /lights/Bulb; did you mean /nodes/Lamp/translation?");
  EXPECT_EQ(said_of("/nodes/Sphere/roughnessFactor"),
            "no \"roughnessFactor\" in /nodes/Sphere; did you mean "
            "/materials/Gold/pbrMetallicRoughness/roughnessFactor?");
}

TEST(PathHints, pointers_of_the_gltf_object_model_get_them_too) {
  EXPECT_EQ(said_of("/materials/0/roughnessFactor"),
            "no \"roughnessFactor\" in /materials/Gold; did you mean "
            "/materials/Gold/pbrMetallicRoughness/roughnessFactor?");
  EXPECT_EQ(said_of("/extensions/KHR_lights_punctual/lights/0/colour"),
            "no \"colour\" in /lights/Bulb; did you mean /lights/Bulb/color?");
}

TEST(PathHints, unknown_keys_of_values_name_the_deeper_place) {
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/materials/New", "value": {"roughnessFactor": 0.5}}])"),
            "/edit/0/value/roughnessFactor: unknown key \"roughnessFactor\"; did you mean "
            "/materials/New/pbrMetallicRoughness/roughnessFactor?");
}

TEST(ValueHints, three_angles_are_no_quaternion) {
  EXPECT_EQ(
      refusal(R"([{"op": "replace", "path": "/nodes/Sphere/rotation", "value": [0, 90, 0]}])"),
      "/edit/0/value: expected an array of 4 numbers, got 3; a rotation is a quaternion: [0,90,0] degrees about x, "
      "then y, then z are [0, 0.707107, 0, 0.707107]");
}

TEST(ValueHints, colours_of_bytes_and_angles_of_degrees) {
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/materials/Gold/pbrMetallicRoughness/baseColorFactor",
                         "value": [255, 128, 0, 1]}])"),
            "/edit/0/value/0: 255 is above 1; colours are linear, from 0 to 1: [255,128,0,1] of sRGB from 0 to 255 is "
            "[1, 0.215861, 0, 1]");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/lights/Cone/spot/outerConeAngle", "value": 45}])"),
            "/edit/0/value: 45 is above 1.5707963267948966; angles are in radians: 45 degrees are 0.785398");
}

TEST(ValueHints, what_is_taken_but_hardly_meant_is_warned_of) {
  const auto warnings_of = [](const std::string& operation) {
    return slip_warnings(
        parse_journal(R"({"relook": "journal/1", "steps": [{"edit": [)" + operation + "]}]}", "j.json"));
  };
  const std::string turned = R"({"op": "replace", "path": "/scene/extras/relook/environment/rotation", "value": )";
  EXPECT_EQ(
      warnings_of(turned + "90}"),
      std::vector<std::string>{"j.json: /steps/0/edit/0/value: 90 is taken for radians; so many degrees are 1.5708"});
  EXPECT_TRUE(warnings_of(turned + "1.5708}").empty());
  EXPECT_EQ(warnings_of(R"({"op": "replace", "path": "/lights/Bulb/color", "value": [255, 240, 200]})").size(), 1U);
  EXPECT_TRUE(warnings_of(R"({"op": "replace", "path": "/lights/Bulb/color", "value": [2, 1.5, 1]})").empty());
}

}  // namespace
}  // namespace relook
