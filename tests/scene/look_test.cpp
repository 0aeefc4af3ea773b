// The look document of a glTF file: names for indices, defaults that are filled in, references that are checked.
#include "scene/look/look.h"

#include <gtest/gtest.h>

#include <set>

#include "look_fixture.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

ImportedGltf imported_of(const char* gltf) {
  ImportedGltf imported;
  imported.file = "t.gltf";
  imported.gltf = Json::parse(gltf);
  return imported;
}

Json look_at(const Json& look, const char* pointer) { return look.at(Json::json_pointer(pointer)); }

TEST(Look, missing_names_are_the_kind_and_the_index) {
  const LookDocument document = make_look_document(imported_of(
      R"({"materials": [{}, {"name": ""}], "textures": [{}], "samplers": [{}], "nodes": [{}],
          "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}})"));
  EXPECT_TRUE(document.look["materials"].contains("material_0"));
  EXPECT_TRUE(document.look["materials"].contains("material_1"));
  EXPECT_TRUE(document.look["textures"].contains("texture_0"));
  EXPECT_TRUE(document.look["samplers"].contains("sampler_0"));
  EXPECT_TRUE(document.look["lights"].contains("light_0"));
  EXPECT_TRUE(document.look["nodes"].contains("node_0"));
}

TEST(Look, repeated_names_get_the_first_free_suffix) {
  const LookDocument document = make_look_document(
      imported_of(R"({"materials": [{"name": "A"}, {"name": "A"}, {"name": "A_2"}, {"name": "A"}]})"));
  EXPECT_EQ(document.order[0], (std::vector<std::string>{"A", "A_2", "A_2_2", "A_3"}));
}

TEST(Look, any_number_of_equal_names_takes_two_looks_each) {
  constexpr std::size_t kNames = 200'000;
  UniqueNames unique;
  EXPECT_EQ(unique.give("A_7"), "A_7");
  std::string last;
  for (std::size_t i = 0; i < kNames; ++i) last = unique.give("A");
  EXPECT_EQ(last, "A_200001");
  EXPECT_LE(unique.probes(), 2 * kNames + 2);
}

TEST(Look, names_given_are_those_of_a_search_from_two) {
  std::set<std::string> taken;
  UniqueNames unique([](const std::string& name) { return name == "B_3"; });
  for (const char* wanted : {"A", "A_2", "A", "A_2", "A", "B", "B", "A_2_2", "B", "B_2", "B", "A_3", "A_4", "A"}) {
    const std::string expected =
        unique_name(wanted, [&](const std::string& name) { return name == "B_3" || taken.contains(name); });
    taken.insert(expected);
    EXPECT_EQ(unique.give(wanted), expected);
  }
}

TEST(Look, control_bytes_leave_names) {
  const LookDocument document = make_look_document(imported_of("{\"materials\": [{\"name\": \"A\\u0007\\nB\"}]}"));
  EXPECT_EQ(document.order[0], (std::vector<std::string>{"AB"}));
}

TEST(Look, indices_become_names) {
  const LookDocument document = make_look_document(small_gltf());
  const Json& look = document.look;
  EXPECT_EQ(look_at(look, "/nodes/Sphere/mesh"), "Ball");
  EXPECT_EQ(look_at(look, "/nodes/Group/children"), Json({"Sphere", "Arm"}));
  EXPECT_EQ(look_at(look, "/nodes/Eye/camera"), "Lens");
  EXPECT_EQ(look_at(look, "/nodes/Lamp/extensions/KHR_lights_punctual/light"), "Bulb");
  EXPECT_EQ(look_at(look, "/meshes/Ball/primitives/0/material"), "Gold");
  EXPECT_EQ(look_at(look, "/materials/Gold/pbrMetallicRoughness/baseColorTexture/index"), "Wood");
  EXPECT_EQ(look_at(look, "/textures/Wood/source"), "WoodImage");
  EXPECT_EQ(look_at(look, "/textures/Wood/sampler"), "sampler_0");
}

TEST(Look, nodes_outside_the_active_scene_are_left_out) {
  const LookDocument document = make_look_document(small_gltf());
  EXPECT_FALSE(document.look["nodes"].contains("Elsewhere"));
  EXPECT_EQ(document.look["nodes"].size(), 11U);
}

TEST(Look, without_scenes_every_root_is_there) {
  const LookDocument document =
      make_look_document(imported_of(R"({"nodes": [{"name": "B"}, {"name": "A", "children": [0]}]})"));
  EXPECT_EQ(document.look["nodes"].size(), 2U);
}

TEST(Look, every_default_is_filled_in) {
  const LookDocument document = make_look_document(small_gltf());
  const Json& look = document.look;
  EXPECT_EQ(look_at(look, "/materials/Mirror/pbrMetallicRoughness/baseColorFactor"), Json({1, 1, 1, 1}));
  EXPECT_EQ(look_at(look, "/materials/Gold/extensions/KHR_materials_ior/ior"), 1.5);
  EXPECT_EQ(look_at(look, "/materials/Gold/extensions/KHR_materials_sheen/sheenColorFactor"), Json({0, 0, 0}));
  EXPECT_EQ(look_at(look, "/materials/Gold/extras/relook/model"), "metallic-roughness");
  EXPECT_EQ(look_at(look, "/materials/Phong/extras/relook/shininess"), 32);
  EXPECT_EQ(
      look_at(look, "/materials/Gold/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale"),
      Json({1, 1}));
  EXPECT_EQ(look_at(look, "/nodes/Sphere/extensions/KHR_node_visibility/visible"), true);
  EXPECT_EQ(look_at(look, "/nodes/Floor/translation"), Json({0, 0, 0}));
  EXPECT_EQ(look_at(look, "/lights/Bulb/color"), Json({1, 1, 1}));
  EXPECT_EQ(look_at(look, "/lights/Cone/spot/innerConeAngle"), 0);
  EXPECT_EQ(look_at(look, "/samplers/sampler_0/wrapT"), 10497);
  EXPECT_EQ(look_at(look, "/textures/Marble/extras/relook/procedural/octaves"), 4);
  EXPECT_EQ(look_at(look, "/scene/extras/relook/environment/intensity"), 1);
}

TEST(Look, infinite_values_are_absent_and_a_matrix_stands_alone) {
  const Json look = make_look_document(small_gltf()).look;
  EXPECT_FALSE(look["lights"]["Bulb"].contains("range"));
  EXPECT_FALSE(look_at(look, "/materials/Glass/extensions/KHR_materials_volume").contains("attenuationDistance"));
  EXPECT_TRUE(look["nodes"]["Hand"].contains("matrix"));
  EXPECT_FALSE(look["nodes"]["Hand"].contains("translation"));
}

TEST(Look, what_is_not_supported_is_left_out) {
  const LookDocument document = make_look_document(imported_of(
      R"({"materials": [{"name": "A", "extras": "text", "extensions": {"KHR_materials_subsurface": {}}}],
          "animations": [{}], "skins": [{}], "accessors": [{}]})"));
  EXPECT_FALSE(document.look["materials"]["A"]["extensions"].contains("KHR_materials_subsurface"));
  EXPECT_TRUE(document.look["materials"]["A"]["extras"].is_object());
  for (const char* key : {"animations", "accessors", "cameras", "asset"}) EXPECT_FALSE(document.look.contains(key));
  EXPECT_FALSE(make_look_document(small_gltf()).look["meshes"]["Ball"]["primitives"][0].contains("attributes"));
}

TEST(Look, unlit_is_a_model_unless_one_is_given) {
  const LookDocument document = make_look_document(imported_of(
      R"({"materials": [{"name": "A", "extensions": {"KHR_materials_unlit": {}}},
                        {"name": "B", "extensions": {"KHR_materials_unlit": {}}, "extras": {"relook": {"model": "blinn-phong"}}}]})"));
  EXPECT_EQ(look_at(document.look, "/materials/A/extras/relook/model"), "unlit");
  EXPECT_EQ(look_at(document.look, "/materials/B/extras/relook/model"), "blinn-phong");
}

TEST(Look, variants_are_names) {
  ImportedGltf imported = imported_of(
      R"({"extensions": {"KHR_materials_variants": {"variants": [{"name": "Day"}, {"name": "Night"}]}},
          "materials": [{"name": "A"}],
          "meshes": [{"primitives": [{"extensions": {"KHR_materials_variants": {"mappings": [{"material": 0, "variants": [1]}]}}}]}]})");
  imported.meshes.resize(1);
  const LookDocument document = make_look_document(std::move(imported));
  EXPECT_EQ(look_at(document.look, "/extensions/KHR_materials_variants/variants"), Json({"Day", "Night"}));
  EXPECT_EQ(look_at(document.look, "/meshes/mesh_0/primitives/0/extensions/KHR_materials_variants/mappings/0"),
            Json({{"material", "A"}, {"variants", {"Night"}}}));
}

TEST(Look, filling_defaults_twice_changes_nothing) {
  LookDocument document = make_look_document(small_gltf());
  const Json once = document.look;
  for (std::size_t s = 0; s < kSectionCount; ++s)
    for (Json& value : document.look[std::string(section_name(static_cast<Section>(s)))])
      fill_defaults(static_cast<Section>(s), value);
  EXPECT_EQ(document.look, once);
}

TEST(Look, defaults_leave_values_of_a_wrong_type_alone) {
  Json value = {{"pbrMetallicRoughness", 5}, {"extras", "x"}};
  fill_defaults(Section::materials, value);
  EXPECT_EQ(value["pbrMetallicRoughness"], 5);
  EXPECT_EQ(value["extras"], "x");
  Json text = "none";
  fill_defaults(Section::nodes, text);
  EXPECT_EQ(text, "none");
}

TEST(Look, automatic_lights_have_free_names_and_light_a_white_surface_to_0_8) {
  LookDocument document = make_look_document(small_gltf());
  document.look["nodes"]["key"] = document.look["nodes"]["Floor"];
  (void)add_auto_lights(document, choose_camera(document, "auto", 64, 64));
  for (const char* name : {"key_2", "fill", "rim"}) {
    EXPECT_TRUE(document.look["lights"].contains(name)) << name;
    EXPECT_EQ(look_at(document.look["nodes"][name], "/extensions/KHR_lights_punctual/light"), name);
  }
  EXPECT_NEAR(document.look["lights"]["key_2"]["intensity"].get<double>() / 3.14159265, 0.8, 1e-6);
}

TEST(Look, automatic_key_light_shines_away_from_the_camera) {
  LookDocument document = make_look_document(small_gltf());
  const Camera camera = choose_camera(document, "auto", 64, 64);
  (void)add_auto_lights(document, camera);
  const SceneState state(std::move(document), camera, small_pyramids());
  for (LightId id : state.scene().light_order)
    if (state.scene().light(id).node == "key") {
      EXPECT_GT(state.scene().light(id).direction.dot(camera.forward), 0.3F);
      EXPECT_LT(state.scene().light(id).direction.dot(camera.up), -0.3F);
    }
}

TEST(Look, only_what_stands_in_the_world_must_be_near_enough) {
  LookDocument document = make_look_document(small_gltf());
  const Camera camera = choose_camera(document, "auto", 8, 8);
  Json far{{"translation", {3e38, 0, 0}}};
  fill_defaults(Section::nodes, far);
  document.look["nodes"]["Empty"] = far;
  Json wide{{"scale", {1e13, 1e13, 1e13}}, {"children", {"Small"}}},
      small{{"scale", {1e-13, 1e-13, 1e-13}}, {"mesh", "Ball"}};
  fill_defaults(Section::nodes, wide);
  fill_defaults(Section::nodes, small);
  document.look["nodes"]["Wide"] = wide;
  document.look["nodes"]["Small"] = small;
  EXPECT_EQ(message_of([&] { (void)SceneState(document, camera, small_pyramids()); }), "");
  document.look["nodes"]["Empty"]["mesh"] = "Ball";
  EXPECT_NE(message_of([&] { (void)SceneState(document, camera, small_pyramids()); }).find("/nodes/Empty: the node's place"),
            std::string::npos);
}

}  // namespace
}  // namespace relook
