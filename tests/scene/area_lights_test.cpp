// EXT_lights_area (draft, glTF pull request 2525) in a file: one section of lights with those of KHR_lights_punctual,
// and one sentence for each way to write it wrong.
#include "import_values.h"
#include "look_fixture.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

class AreaLights : public ImportValues {
 protected:
  /// A scene whose first node has light `reference` of these lights.
  [[nodiscard]] Answer with(const Json& lights, const Json& reference) const {
    Json gltf = text_scene();
    gltf["extensionsRequired"] = {"EXT_lights_area"};
    gltf["extensionsUsed"] = {"EXT_lights_area"};
    gltf["extensions"]["EXT_lights_area"]["lights"] = lights;
    gltf["nodes"][0]["extensions"]["EXT_lights_area"] = reference;
    return answer(gltf.dump(), "inner/scene.gltf");
  }
};

TEST_F(AreaLights, stand_beside_punctual_ones_with_names_of_their_own) {
  ImportedGltf imported;
  imported.file = "t.gltf";
  imported.gltf = Json::parse(R"({
    "extensions": {
      "KHR_lights_punctual": {"lights": [{"name": "Key", "type": "point"}, {"name": "Rim", "type": "spot"}]},
      "EXT_lights_area": {"lights": [{"name": "Key", "type": "rect"}, {"type": "disk", "size": 3, "intensity": 5}]}},
    "nodes": [{"name": "A", "extensions": {"EXT_lights_area": {"light": 0}}},
              {"name": "B", "extensions": {"EXT_lights_area": {"light": 1}}},
              {"name": "C", "extensions": {"KHR_lights_punctual": {"light": 0}}}]})");
  const LookDocument document = make_look_document(std::move(imported));
  const Json& lights = document.look["lights"];
  EXPECT_EQ(lights.size(), 4U);
  EXPECT_EQ(lights["Key"]["type"], "point");
  EXPECT_EQ(lights["Key_2"]["type"], "rect");
  EXPECT_EQ(lights["Key_2"]["intensity"], 1000);
  EXPECT_EQ(lights["Key_2"]["size"], 1);
  EXPECT_EQ(lights["Key_2"]["rect"]["aspect"], 1);
  EXPECT_EQ(lights["light_3"]["intensity"], 5);
  EXPECT_FALSE(lights["Key"].contains("size"));
  const Json& nodes = document.look["nodes"];
  EXPECT_EQ(nodes["A"]["extensions"]["EXT_lights_area"]["light"], "Key_2");
  EXPECT_EQ(nodes["B"]["extensions"]["EXT_lights_area"]["light"], "light_3");
  EXPECT_EQ(nodes["C"]["extensions"]["KHR_lights_punctual"]["light"], "Key");
  std::vector<std::string> area{"extensions", "EXT_lights_area", "lights", "1", "size"};
  resolve_light_place(document, area);
  EXPECT_EQ(area, (std::vector<std::string>{"lights", "light_3", "size"}));
  EXPECT_EQ(resolve_token(document, Section::lights, "1"), "Rim");
  EXPECT_EQ(resolve_token(document, Section::lights, "2"), "2");  // punctual ones are two
}

TEST_F(AreaLights, of_a_file_are_checked_at_their_place) {
  const Json one = {{"light", 0}};
  EXPECT_EQ(with(Json::parse(R"([{"type": "rect", "size": 2, "rect": {"aspect": 0.5}}])"), one).error, "");
  const std::pair<Json, const char*> wrong[] = {
      {{{"size", 2}}, "\"type\" is missing"},
      {{{"type", "sphere"}}, "\"sphere\" is not one of rect, disk"},
      {{{"type", "point"}}, "\"point\" is not one of rect, disk"},
      {{{"type", "rect"}, {"size", 0}}, "0 is not above 0"},
      {{{"type", "rect"}, {"size", "big"}}, "expected a number"},
      {{{"type", "rect"}, {"rect", {{"aspect", -1}}}}, "-1 is not above 0"},
      {{{"type", "disk"}, {"intensity", -5}}, "-5 is below 0"},
      {{{"type", "disk"}, {"color", {1, 1}}}, "expected an array of 3 numbers"},
  };
  for (const auto& [light, what] : wrong) {
    const std::string error = with(Json::array({light}), one).error;
    EXPECT_NE(error.find(what), std::string::npos) << light << ": " << error;
    EXPECT_NE(error.find("/extensions/EXT_lights_area/lights/0"), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}

TEST_F(AreaLights, references_lead_to_lights) {
  const Json lights = Json::parse(R"([{"type": "rect"}])");
  EXPECT_NE(with(lights, {{"light", 1}}).error.find("there is no light 1; the file has 1"), std::string::npos);
  EXPECT_NE(with(lights, {{"light", -1}}).error.find("there is no light -1"), std::string::npos);
  EXPECT_NE(with(lights, Json::object()).error, "");
  EXPECT_NE(with(lights, 3).error, "");
  EXPECT_NE(with(3, {{"light", 0}}).error, "");
  EXPECT_NE(with(Json::array({3}), {{"light", 0}}).error, "");
}

TEST_F(AreaLights, a_node_has_one_light) {
  Json gltf = text_scene();
  gltf["extensions"]["EXT_lights_area"]["lights"] = Json::parse(R"([{"type": "rect"}])");
  gltf["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "point"}])");
  gltf["nodes"][0]["extensions"] = {{"EXT_lights_area", {{"light", 0}}}, {"KHR_lights_punctual", {{"light", 0}}}};
  const std::string error = answer(gltf.dump(), "inner/scene.gltf").error;
  EXPECT_NE(error.find("/nodes/0/extensions/EXT_lights_area"), std::string::npos) << error;
}

TEST_F(AreaLights, punctual_ones_are_no_areas) {
  Json gltf = text_scene();
  gltf["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "rect"}])");
  gltf["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const std::string error = answer(gltf.dump(), "inner/scene.gltf").error;
  EXPECT_NE(error.find("\"rect\" is not one of point, spot, directional"), std::string::npos) << error;
}

}  // namespace
}  // namespace relook
