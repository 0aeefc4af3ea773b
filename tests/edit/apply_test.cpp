// Edits: RFC 6902 on the look document in place, atomic, checked, with the entities around them kept consistent.
#include "edit/apply.h"

#include <gtest/gtest.h>

#include "refusal.h"

namespace relook {
namespace {

constexpr const char* kGlassVolume = "/materials/Glass/extensions/KHR_materials_volume";
constexpr const char* kGoldTexture = "/materials/Gold/pbrMetallicRoughness/baseColorTexture";

TEST(Patch, replaces_a_value_and_a_component) {
  SceneState state = small_state();
  (void)apply_json(
      state, R"([{"op": "replace", "path": "/materials/Gold/pbrMetallicRoughness/baseColorFactor/1", "value": 0.5},
                              {"op": "replace", "path": "/lights/Bulb/intensity", "value": 7}])");
  EXPECT_EQ(state.scene().material(MaterialId(2)).name, "Gold");
  EXPECT_EQ(state.scene().material(MaterialId(2)).base_color.g, 0.5F);
  EXPECT_EQ(look_at(state, "/lights/Bulb/intensity"), 7);
}

TEST(Patch, adds_into_arrays_and_at_their_end) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "remove", "path": "/nodes/Group/children/1"},
                              {"op": "add", "path": "/nodes/Group/children/0", "value": "Arm"},
                              {"op": "add", "path": "/nodes/Group/children/-", "value": "Floor"}])");
  EXPECT_EQ(look_at(state, "/nodes/Group/children"), Json({"Arm", "Sphere", "Floor"}));
  EXPECT_EQ(state.parent_of("Floor"), "Group");
}

TEST(Patch, removing_a_member_brings_its_default_back) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "remove", "path": "/materials/Gold/pbrMetallicRoughness/roughnessFactor"},
                              {"op": "remove", "path": "/materials/Glass/extensions/KHR_materials_transmission"},
                              {"op": "replace", "path": "/materials/Gold/pbrMetallicRoughness/roughnessFactor", "value": 0.75}])");
  EXPECT_EQ(look_at(state, "/materials/Glass/extensions/KHR_materials_transmission/transmissionFactor"), 0);
  EXPECT_EQ(look_at(state, "/materials/Gold/pbrMetallicRoughness/roughnessFactor"), 0.75);
}

TEST(Patch, copies_and_moves_values) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "copy", "from": "/materials/Gold", "path": "/materials/Gilt"},
                              {"op": "move", "from": "/materials/Gilt", "path": "/materials/Leaf"},
                              {"op": "replace", "path": "/meshes/Slab/primitives/0/material", "value": "Leaf"}])");
  EXPECT_FALSE(state.document().look["materials"].contains("Gilt"));
  EXPECT_EQ(look_at(state, "/materials/Leaf"), look_at(state, "/materials/Gold"));
}

TEST(Patch, test_is_a_guard_that_compares_numbers_by_value) {
  SceneState state = small_state();
  (void)apply_json(state,
                   R"([{"op": "test", "path": "/materials/Gold/pbrMetallicRoughness/metallicFactor", "value": 1}])");
  EXPECT_EQ(refusal(state, R"([{"op": "replace", "path": "/lights/Bulb/intensity", "value": 1},
                              {"op": "test", "path": "/lights/Sunlight/intensity", "value": 2}])"),
            "/edit/1/value: the test failed: /lights/Sunlight/intensity is 1.0");
}

TEST(Patch, escapes_and_indices_in_pointers) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "add", "path": "/materials/a~1b~0c", "value": {}},
                              {"op": "replace", "path": "/materials/1/extensions/KHR_materials_ior/ior", "value": 2},
                              {"op": "replace", "path": "/meshes/0/primitives/0/material", "value": 1},
                              {"op": "replace", "path": "/extensions/KHR_lights_punctual/lights/0/intensity", "value": 3}])");
  EXPECT_TRUE(state.document().look["materials"].contains("a/b~c"));
  EXPECT_EQ(look_at(state, "/materials/Glass/extensions/KHR_materials_ior/ior"), 2);
  EXPECT_EQ(look_at(state, "/meshes/Ball/primitives/0/material"), "Glass");
  EXPECT_EQ(look_at(state, "/lights/Bulb/intensity"), 3);
}

TEST(Patch, whole_sections_and_the_whole_document) {
  SceneState state = small_state();
  Json look = state.document().look;
  look["materials"]["Gold"]["alphaCutoff"] = 0.125;
  const Json edit = Json::array({{{"op", "replace"}, {"path", ""}, {"value", look}}});
  const SceneDelta delta = apply_json(state, edit.dump());
  EXPECT_EQ(delta.materials.size(), 1U);
  EXPECT_TRUE(delta.objects.empty());
  const Json lights = Json::array({{{"op", "replace"}, {"path", "/lights"}, {"value", look["lights"]}}});
  EXPECT_TRUE(apply_json(state, lights.dump()).empty());
}

TEST(ActiveCamera, is_fixed) {
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/nodes/Eye/translation", "value": [1, 0, 0]}])"),
            "/edit/0/path: node \"Eye\" holds the active camera, which is fixed");
  EXPECT_EQ(refusal(R"([{"op": "replace", "path": "/nodes/Rig/translation", "value": [1, 0, 0]}])"),
            "/edit/0/path: /nodes/Eye: this moves or hides the active camera, which is fixed");
  EXPECT_EQ(
      refusal(R"([{"op": "replace", "path": "/nodes/Rig/extensions/KHR_node_visibility/visible", "value": false}])"),
      "/edit/0/path: /nodes/Eye: this moves or hides the active camera, which is fixed");
  EXPECT_EQ(refusal(R"([{"op": "remove", "path": "/nodes/Rig"}])"),
            "/edit/0/path: /nodes/Eye: the active camera's node cannot be removed");
  EXPECT_EQ(refusal(R"([{"op": "add", "path": "/cameras/Lens/perspective/yfov", "value": 1}])"),
            "/edit/0/path: cameras are fixed and cannot be edited");
}

TEST(ActiveCamera, its_ancestors_may_get_other_children) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "add", "path": "/nodes/Rig/children/-", "value": "Floor"}])");
  EXPECT_EQ(state.parent_of("Floor"), "Rig");
}

TEST(Nodes, removing_one_takes_its_descendants_and_its_mention) {
  SceneState state = small_state();
  const SceneDelta delta = apply_json(state, R"([{"op": "remove", "path": "/nodes/Arm"}])");
  EXPECT_FALSE(state.document().look["nodes"].contains("Hand"));
  EXPECT_EQ(look_at(state, "/nodes/Group/children"), Json({"Sphere"}));
  ASSERT_EQ(delta.objects.size(), 1U);
  EXPECT_EQ(delta.objects[0].before.node, "Hand");
  EXPECT_FALSE(state.scene().object(delta.objects[0].id).alive);
}

TEST(Nodes, removing_a_light_node_keeps_the_light) {
  SceneState state = small_state();
  const SceneDelta delta = apply_json(state, R"([{"op": "remove", "path": "/nodes/Lamp"}])");
  EXPECT_EQ(delta.lights.size(), 1U);
  EXPECT_TRUE(state.document().look["lights"].contains("Bulb"));
  EXPECT_EQ(state.scene().light_order.size(), 1U);
}

TEST(Nodes, adding_removing_and_adding_again_gives_the_same_scene) {
  SceneState state = small_state();
  const std::string add =
      R"([{"op": "add", "path": "/nodes/Chair", "value": {"mesh": "Pair", "translation": [1, 2, 3]}}])";
  (void)apply_json(state, add);
  const std::string once = scene_text(state.scene());
  (void)apply_json(state, R"([{"op": "remove", "path": "/nodes/Chair"}])");
  (void)apply_json(state, add);
  EXPECT_EQ(scene_text(state.scene()), once);
}

TEST(Nodes, a_parent_and_its_child_can_come_in_one_edit) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "add", "path": "/nodes/P", "value": {"children": ["C"], "translation": [0, 0, 9]}},
                              {"op": "add", "path": "/nodes/C", "value": {"mesh": "Ball"}},
                              {"op": "remove", "path": "/nodes/Group"}])");
  for (const Object& object : state.scene().objects) {
    if (object.node == "C") {
      EXPECT_EQ(object.to_world[3][2], 9);
    }
  }
}

TEST(Nodes, renaming_keeps_the_place_in_the_hierarchy) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "move", "from": "/nodes/Arm", "path": "/nodes/Limb"}])");
  EXPECT_EQ(look_at(state, "/nodes/Group/children"), Json({"Sphere", "Limb"}));
  EXPECT_EQ(state.parent_of("Hand"), "Limb");
}

TEST(Nodes, copying_one_copies_its_descendants) {
  SceneState state = small_state();
  const SceneDelta delta = apply_json(state, R"([{"op": "copy", "from": "/nodes/Group", "path": "/nodes/Twin"}])");
  EXPECT_EQ(look_at(state, "/nodes/Twin/children"), Json({"Twin/Sphere", "Twin/Arm"}));
  EXPECT_EQ(look_at(state, "/nodes/Twin~1Arm/children"), Json({"Twin/Hand"}));
  EXPECT_EQ(delta.objects.size(), 2U);
}

TEST(Meshes, a_copy_has_materials_of_its_own) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "copy", "from": "/meshes/Slab", "path": "/meshes/Slab2"},
                              {"op": "replace", "path": "/meshes/Slab2/primitives/0/material", "value": "Glass"},
                              {"op": "replace", "path": "/nodes/Hand/mesh", "value": "Slab2"}])");
  for (const Object& object : state.scene().objects) {
    if (object.node != "Hand" && object.node != "Floor") continue;
    EXPECT_EQ(state.scene().material(object.material).name, object.node == "Hand" ? "Glass" : "Mirror");
  }
}

TEST(Nodes, copying_one_over_its_own_descendant_is_refused) {
  EXPECT_EQ(refusal(R"([{"op": "copy", "from": "/nodes/Group", "path": "/nodes/Sphere"}])"),
            "/edit/0/path: a node cannot be copied over one of its own descendants");
}

TEST(Materials, unlit_follows_the_extension) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "add", "path": "/materials/Gold/extensions/KHR_materials_unlit", "value": {}}])");
  EXPECT_EQ(state.scene().material(MaterialId(2)).model, IlluminationModel::unlit);
  (void)apply_json(state, R"([{"op": "remove", "path": "/materials/Gold/extensions/KHR_materials_unlit"}])");
  EXPECT_EQ(state.scene().material(MaterialId(2)).model, IlluminationModel::metallic_roughness);
}

// An infinite range has no number, and a mapping depends on the mesh: the document omits both.
TEST(Patch, replace_finds_the_defaults_that_cannot_be_written) {
  SceneState state = small_state();
  (void)apply_json(state, R"([
    {"op": "replace", "path": "/lights/Bulb/range", "value": 4},
    {"op": "replace", "path": "/materials/Glass/extensions/KHR_materials_volume/attenuationDistance", "value": 0.5},
    {"op": "replace", "path": "/materials/Gold/pbrMetallicRoughness/baseColorTexture/extras/relook/mapping",
     "value": {"kind": "planar"}}])");
  EXPECT_EQ(look_at(state, "/lights/Bulb/range"), 4);
  EXPECT_EQ(look_at(state, kGlassVolume).at("attenuationDistance"), 0.5);
  EXPECT_EQ(look_at(state, kGoldTexture).at("extras"),
            Json::parse(R"({"relook": {"mapping": {"kind": "planar", "axis": "y"}}})"));
  EXPECT_EQ(state.scene().material(MaterialId(1)).name, "Glass");
  EXPECT_EQ(state.scene().material(MaterialId(1)).attenuation_distance, 0.5F);
  (void)apply_json(state, R"([{"op": "replace", "path": "/lights/Bulb/range", "value": 5},
                              {"op": "remove", "path": "/lights/Bulb/range"}])");
  EXPECT_FALSE(look_at(state, "/lights/Bulb").contains("range"));
}

TEST(Patch, replace_below_a_displacement_finds_its_mapping) {
  SceneState state = small_state();
  (void)apply_json(
      state,
      R"([{"op": "add", "path": "/nodes/Floor/extras", "value": {"relook": {"displacement": {"texture": "Marble"}}}},
                 {"op": "replace", "path": "/nodes/Floor/extras/relook/displacement/mapping", "value": {"kind": "solid"}}])");
  EXPECT_EQ(look_at(state, "/nodes/Floor/extras/relook/displacement/mapping/kind"), "solid");
}

TEST(Patch, replace_below_a_displacement_finds_its_texture_transform) {
  SceneState state = small_state();
  const std::string displacement = "/nodes/Sphere/extras/relook/displacement";
  (void)apply_json(
      state,
      R"([{"op": "add", "path": "/nodes/Sphere/extras", "value": {"relook": {"displacement": {"texture": "Bumps"}}}},
                 {"op": "replace", "path": ")" +
          displacement + R"(/extensions/KHR_texture_transform/scale", "value": [2, 3]},
                 {"op": "replace", "path": ")" +
          displacement + R"(/extensions/KHR_texture_transform/offset/1", "value": 0.25},
                 {"op": "replace", "path": ")" +
          displacement + R"(/extensions/KHR_texture_transform/rotation", "value": 0.5},
                 {"op": "replace", "path": ")" +
          displacement + R"(/texCoord", "value": 1}])");
  for (const Object& object : state.scene().objects) {
    if (object.node != "Sphere") continue;
    ASSERT_TRUE(object.displacement);
    const TextureSlot& slot = object.displacement->texture;
    EXPECT_EQ(slot.scale, Imath::V2f(2, 3));
    EXPECT_EQ(slot.offset, Imath::V2f(0, 0.25F));
    EXPECT_EQ(slot.rotation, 0.5F);
    EXPECT_EQ(slot.texcoord, 1);
  }
  EXPECT_EQ(message_of([&] {
              (void)apply_json(state, R"([{"op": "replace", "path": ")" + displacement + R"(/texCoord", "value": 2}])");
            }),
            "j.json: /edit/0/value: 2 is above 1");
  EXPECT_EQ(message_of([&] {
              (void)apply_json(state, R"([{"op": "add", "path": ")" + displacement +
                                          R"(/extensions/KHR_texture_transform/offest", "value": [0, 0]}])");
            }),
            "j.json: /edit/0/path: unknown key \"offest\"; did you mean \"offset\"?");
}

}  // namespace
}  // namespace relook
