// Edits that are refused: the message names the operation and the place, suggests what may have been meant, and the
// look document and the scene stay as they were.
#include <gtest/gtest.h>

#include "refusal.h"

namespace relook {
namespace {

TEST(PatchErrors, name_the_operation_and_suggest_the_nearest) {
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/materials/Gould/alphaCutoff", "value": 0}])"),
            "/edit/0/path: no material \"Gould\"; did you mean \"Gold\"?");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/material/Gold", "value": 0}])"),
            "/edit/0/path: no \"material\"; did you mean /materials/Gold?");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/materials/Gold/alphaCutof", "value": 0}])"),
            "/edit/0/path: no \"alphaCutof\" in /materials/Gold; did you mean /materials/Gold/alphaCutoff?");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/materials/Gold/alphaCutof", "value": 0}])"),
            "/edit/0/path: no \"alphaCutof\" in /materials/Gold; did you mean /materials/Gold/alphaCutoff?");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/materials/New", "value": {"doublesided": true}}])"),
            "/edit/0/value/doublesided: unknown key \"doublesided\"; did you mean \"doubleSided\"?");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/nodes/Sphere/mesh", "value": "Bal"}])"),
            "/edit/0/value: no mesh \"Bal\"; did you mean \"Ball\"?");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/nodes/Sphere/mesh", "value": 99}])"),
            "/edit/0/value: there is no mesh of index 99");
  EXPECT_EQ(refusal(R"([{"op": "copy", "from": "/materials/Gould", "path": "/materials/B"}])"),
            "/edit/0/from: no material \"Gould\"; did you mean \"Gold\"?");
}

TEST(PatchErrors, arrays) {
  const std::string children = R"([{"op": "add", "path": "/nodes/Group/children/)";
  EXPECT_EQ(refusal(children + R"(3", "value": "Floor"}])"),
            "/edit/0/path: index 3 is past the end of an array of 3 in /nodes/Group/children");
  EXPECT_EQ(refusal(children + R"(01", "value": "Floor"}])"),
            "/edit/0/path: \"01\" is no array index in /nodes/Group/children");
  EXPECT_EQ(refusal(R"([{"op": "remove", "path": "/nodes/Group/children/-"}])"),
            "/edit/0/path: \"-\" is no array index in /nodes/Group/children");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/lights/Bulb/intensity/0", "value": 1}])"),
            "/edit/0/path: nothing lies below a plain value in /lights/Bulb/intensity");
}

TEST(PatchErrors, types_and_ranges) {
  const std::string gold = R"([{"op": "replace", "path": "/materials/Gold/)";
  EXPECT_EQ(refusal(gold + R"(pbrMetallicRoughness/roughnessFactor", "value": 1.5}])"),
            "/edit/0/value: 1.5 is above 1");
  EXPECT_EQ(refusal(gold + R"(pbrMetallicRoughness/roughnessFactor", "value": "x"}])"),
            "/edit/0/value: expected a number, got a string");
  EXPECT_EQ(refusal(gold + R"(pbrMetallicRoughness", "value": {"baseColorFactor": [1, 1, 1]}}])"),
            "/edit/0/value/baseColorFactor: expected an array of 4 numbers, got 3");
  EXPECT_EQ(refusal(gold + R"(pbrMetallicRoughness", "value": 5}])"),
            "/edit/0/value: expected an object, got a number");
  EXPECT_EQ(refusal(gold + R"(alphaMode", "value": "MSK"}])"),
            "/edit/0/value: \"MSK\" is not one of OPAQUE, MASK, BLEND; did you mean \"MASK\"?");
  EXPECT_EQ(refusal(gold + R"(doubleSided", "value": 1}])"), "/edit/0/value: expected true or false, got a number");
  EXPECT_EQ(refusal(gold + R"(extensions/KHR_materials_ior/ior", "value": 0.5}])"),
            "/edit/0/value: 0.5 is below 1 and not 0");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/lights/Bulb/range", "value": 0}])"), "/edit/0/value: 0 is not above 0");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/lights/Cone/spot/innerConeAngle", "value": 1}])"),
            "/edit/0/value: the inner cone is not inside the outer cone");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/samplers/0/wrapS", "value": 20000}])"),
            "/edit/0/value: 20000 is not one of 10497, 33071, 33648");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/samplers/0/minFilter", "value": 9800}])"),
            "/edit/0/value: 9800 is not one of 9728, 9729, 9984, 9985, 9986, 9987");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/lights/New", "value": {}}])"), "/edit/0/value: \"type\" is missing");
}

TEST(PatchErrors, nodes) {
  const std::string sphere = R"([{"op": "replace", "path": "/nodes/Sphere/)";
  EXPECT_EQ(refusal(sphere + R"(rotation", "value": [0, 0, 0, 0]}])"),
            "/edit/0/value: a rotation must not be the zero quaternion");
  EXPECT_EQ(refusal(sphere + R"(translation/2", "value": 1e39}])"),
            "/edit/0/value: 1e+39 is above 3.4028234663852886e+38");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/nodes/Hand/translation", "value": [0, 0, 1]}])"),
            "/edit/0/value: a node has either a matrix or translation, rotation and scale");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/nodes/Hand/matrix/3", "value": 1}])"),
            "/edit/0/path: /nodes/Hand/matrix: the matrix is not affine: its last row must be 0, 0, 0, 1");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/nodes/Floor/children/-", "value": "Sphere"}])"),
            "/edit/0/value: node \"Sphere\" is already a child of \"Group\"");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/nodes/Hand/children/-", "value": "Group"}])"),
            "/edit/0/path: /nodes/Group/children: the node is its own ancestor");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/nodes/Floor/children/-", "value": "Floor"}])"),
            "/edit/0/path: /nodes/Floor/children: the node is its own ancestor");
}

TEST(PatchErrors, what_is_still_in_use_cannot_go) {
  EXPECT_EQ(refusal(R"([{"op": "remove", "path": "/materials/Gold"}])"),
            "/edit/0/path: material \"Gold\" is still used by mesh \"Ball\" (/meshes/Ball/primitives/0/material)");
  EXPECT_EQ(refusal(R"([{"op": "remove", "path": "/images/WoodImage"}])"),
            "/edit/0/path: image \"WoodImage\" is still used by texture \"Wood\" (/textures/Wood/source)");
  EXPECT_EQ(refusal(R"([{"op": "remove", "path": "/lights/Bulb"}])"),
            "/edit/0/path: light \"Bulb\" is still used by node \"Lamp\" "
            "(/nodes/Lamp/extensions/KHR_lights_punctual/light)");
  EXPECT_EQ(refusal(R"([{"op": "move", "from": "/lights/Bulb", "path": "/lights/Lantern"}])"),
            "/edit/0/from: light \"Bulb\" is still used by node \"Lamp\" "
            "(/nodes/Lamp/extensions/KHR_lights_punctual/light)");
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "add", "path": "/scene/extras/relook/environment/image", "value": "WoodImage"},
                              {"op": "remove", "path": "/textures/Wood/source"}])");
  EXPECT_EQ(refusal(state, R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 2},
                               {"op": "remove", "path": "/images/WoodImage"}])"),
            "/edit/1/path: image \"WoodImage\" is still used by the scene (/scene/extras/relook/environment/image)");
  EXPECT_NE(refusal(R"([{"op": "remove", "path": "/materials"}])"), "");
  EXPECT_NE(refusal(R"([{"op": "replace", "path": "", "value": 3}])"), "");
  EXPECT_NE(refusal(R"([{"op": "remove", "path": "/scene"}])"), "");
  EXPECT_NE(refusal(R"([{"op": "add", "path": "/accessors", "value": []}])"), "");
}

TEST(PatchErrors, a_later_failure_takes_everything_back) {
  EXPECT_EQ(refusal(R"([{"op": "remove", "path": "/nodes/Group"},
                        {"op": "add", "path": "/materials/New", "value": {}},
                        {"op": "add", "path": "/nodes/N", "value": {"mesh": "Ball"}},
                        {"op": "replace", "path": "/materials/Gold/alphaCutoff", "value": 0.1},
                        {"op": "replace", "path": "/lights/Bulb/intensity", "value": -1}])"),
            "/edit/4/value: -1 is below 0");
}

// "" once stood for the whole section: the entry was never checked, and a later edit failed on it.
TEST(PatchErrors, an_empty_name_is_not_the_whole_section) {
  for (const char* section : {"materials", "textures", "images", "samplers", "meshes", "lights", "nodes"}) {
    const std::string path = "\"/" + std::string(section) + "/";
    const std::string reason = ": a name must not be empty";
    EXPECT_EQ(refusal("[{\"op\": \"add\", \"path\": " + path + "\", \"value\": {}}]"), "/edit/0/path" + reason);
    EXPECT_EQ(refusal("[{\"op\": \"test\", \"path\": " + path + "/name\", \"value\": 1}]"), "/edit/0/path" + reason);
    EXPECT_EQ(refusal("[{\"op\": \"copy\", \"from\": " + path + "\", \"path\": " + path + "N\"}]"),
              "/edit/0/from" + reason);
    EXPECT_EQ(refusal("[{\"op\": \"replace\", \"path\": \"/" + std::string(section) + "\", \"value\": {\"\": {}}}]"),
              "/edit/0/value/" + reason);
  }
  EXPECT_EQ(
      refusal(R"([{"op": "add", "path": "/extensions/KHR_lights_punctual/lights/", "value": {"type": "point"}}])"),
      "/edit/0/path: a name must not be empty");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/meshes/Ball/primitives/0/material", "value": ""}])"),
            "/edit/0/value: no material \"\"");
}

TEST(PatchErrors, an_index_with_leading_zeros_is_a_name) {
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/materials/01/alphaCutoff", "value": 0}])"),
            "/edit/0/path: no material \"01\"");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/materials/00/alphaCutoff", "value": 0}])"),
            "/edit/0/path: no material \"00\"");
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "add", "path": "/materials/01", "value": {}},
                              {"op": "replace", "path": "/materials/0/alphaCutoff", "value": 0.25}])");
  EXPECT_TRUE(state.document().look["materials"].contains("01"));
  EXPECT_EQ(look_at(state, "/materials/Gold/alphaCutoff"), 0.25);
}

TEST(PatchErrors, only_replace_finds_what_is_absent) {
  EXPECT_EQ(refusal(R"([{"op": "remove", "path": "/lights/Bulb/range"}])"),
            "/edit/0/path: no \"range\" in /lights/Bulb");
  EXPECT_EQ(refusal(R"([{"op": "test", "path": "/lights/Bulb/range", "value": null}])"),
            "/edit/0/path: no \"range\" in /lights/Bulb");
  EXPECT_EQ(refusal(R"([{"op": "copy", "from": "/lights/Bulb/range", "path": "/lights/Cone/range"}])"),
            "/edit/0/from: no \"range\" in /lights/Bulb");
}

TEST(PatchErrors, replacing_an_absent_member_without_default_says_use_add) {
  const auto replace = [](const std::string& path) {
    return refusal("[{\"op\": \"replace\", \"path\": \"" + path + "\", \"value\": {}}]");
  };
  EXPECT_EQ(replace("/materials/Gold/normalTexture"),
            "/edit/0/path: no \"normalTexture\" in /materials/Gold (use add)");
  EXPECT_EQ(replace("/materials/Gold/normalTexture/extras/relook/mapping"),
            "/edit/0/path: no \"normalTexture\" in /materials/Gold (use add)");
  EXPECT_EQ(replace("/scene/extras/relook/environment/image"),
            "/edit/0/path: no \"image\" in /scene/extras/relook/environment (use add)");
  EXPECT_EQ(replace("/nodes/Floor/extras/relook/displacement/mapping"),
            "/edit/0/path: no \"displacement\" in /nodes/Floor/extras/relook (use add)");
  EXPECT_EQ(replace("/nodes/Hand/translation").find("use add"), std::string::npos);
  EXPECT_EQ(replace("/nodes/Floor/translation/99999999999999999999"),
            "/edit/0/path: \"99999999999999999999\" is no array index in /nodes/Floor/translation");
}

}  // namespace
}  // namespace relook
