// The compiled scene: what follows from the look document, and that following an edit gives the same as starting
// afresh.
#include "scene/compile/state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <stdexcept>

#include "look_fixture.h"

namespace relook {
namespace {

const Object& object_of(const Scene& scene, std::string_view node, std::uint32_t instance = 0) {
  for (const Object& object : scene.objects)
    if (object.node == node && object.instance == instance) return object;
  throw std::out_of_range("no such object");
}

TEST(Compile, transforms_go_from_root_to_leaf) {
  const SceneState state = small_state();
  const Transform& hand = object_of(state.scene(), "Hand").to_world;  // moved up 3, doubled in y, moved right 1
  EXPECT_EQ(Point(0, 1, 0) * hand, Point(1, 8, 0));
  const Transform& sphere =
      object_of(state.scene(), "Sphere").to_world;  // (0, 0.6, 0, 0.8): x goes to (0.28, 0, -0.96)
  EXPECT_NEAR((Point(1, 0, 0) * sphere).x, 1.28F, 1e-6);
  EXPECT_NEAR((Point(1, 0, 0) * sphere).z, -0.96F, 1e-6);
}

TEST(Compile, primitives_instances_and_materials) {
  const SceneState state = small_state();
  const Scene& scene = state.scene();
  EXPECT_EQ(scene.objects.size(), 7U);  // Sphere, Hand, Floor twice, Window, Both twice
  EXPECT_EQ((Point(0, 0, 0) * object_of(scene, "Floor", 1).to_world), Point(2, 0, 0));
  EXPECT_EQ(scene.material(object_of(scene, "Sphere").material).name, "Gold");
  EXPECT_EQ(scene.materials.size(), 6U);
  EXPECT_EQ(scene.materials.back(), Material());
  std::set<std::uint64_t> keys;
  for (const Object& object : scene.objects) keys.insert(object.key);
  EXPECT_EQ(keys.size(), scene.objects.size());
}

TEST(Compile, textures_reach_their_slots) {
  const SceneState state = small_state();
  for (const Material& material : state.scene().materials) {
    const TextureSlot& slot = material.slot(Slot::base_color);
    if (material.name == "Gold") {
      EXPECT_EQ(slot.kind, TextureKind::image);
      EXPECT_EQ(slot.sampler.wrap_s, Wrap::clamp);
      EXPECT_EQ(slot.pyramid->texels8[0], 200);
    }
    if (material.name == "Phong") {
      EXPECT_EQ(slot.procedural.kind, ProceduralKind::marble);
    }
  }
}

TEST(Compile, lights_stand_at_their_nodes_in_the_order_of_names) {
  const SceneState state = small_state();
  const Scene& scene = state.scene();
  ASSERT_EQ(scene.light_order.size(), 2U);
  EXPECT_EQ(scene.light(scene.light_order[0]).node, "Lamp");
  EXPECT_EQ(scene.light(scene.light_order[0]).position, Point(0, 5, 0));
  EXPECT_EQ(scene.light(scene.light_order[1]).direction, Direction(0, 0, -1));
}

TEST(Compile, hidden_nodes_hide_what_hangs_on_them) {
  SceneState state = small_state();
  const SceneDelta delta = apply_json(
      state, R"([{"op": "replace", "path": "/nodes/Group/extensions/KHR_node_visibility/visible", "value": false}])");
  EXPECT_EQ(delta.objects.size(), 2U);
  EXPECT_FALSE(object_of(state.scene(), "Hand").alive);
}

TEST(Compile, a_scale_of_zero_makes_a_sheet_and_two_make_an_object_disappear) {
  SceneState state = small_state();
  (void)apply_json(state, R"([{"op": "replace", "path": "/nodes/Sphere/scale", "value": [1, 0, 1]}])");
  EXPECT_TRUE(object_of(state.scene(), "Sphere").alive);
  (void)apply_json(state, R"([{"op": "replace", "path": "/nodes/Sphere/scale", "value": [0, 0, 1]}])");
  EXPECT_FALSE(object_of(state.scene(), "Sphere").alive);
}

TEST(Compile, negative_zero_is_zero) {
  SceneState state = small_state();
  EXPECT_TRUE(apply_json(state, R"([{"op": "replace", "path": "/nodes/Floor/translation", "value": [-0.0, 0, -0.0]}])")
                  .empty());
  EXPECT_FALSE(std::signbit(object_of(state.scene(), "Floor").to_world[3][0]));
}

TEST(Delta, lists_what_changed_with_the_value_before) {
  SceneState state = small_state();
  const SceneDelta delta =
      apply_json(state, R"([{"op": "replace", "path": "/nodes/Group/translation", "value": [2, 0, 0]},
                                                 {"op": "replace", "path": "/lights/Bulb/intensity", "value": 1},
                                                 {"op": "replace", "path": "/textures/Wood/sampler", "value": 0}])");
  EXPECT_EQ(delta.objects.size(), 2U);
  EXPECT_EQ(delta.objects[0].before.to_world[3][0], 1);
  ASSERT_EQ(delta.lights.size(), 1U);
  EXPECT_EQ(delta.lights[0].before.intensity, 30);
  EXPECT_TRUE(delta.materials.empty());
}

TEST(Delta, what_appears_was_not_alive_before) {
  SceneState state = small_state();
  const SceneDelta delta = apply_json(state, R"([{"op": "add", "path": "/nodes/N", "value": {"mesh": "Ball"}}])");
  ASSERT_EQ(delta.objects.size(), 1U);
  EXPECT_FALSE(delta.objects[0].before.alive);
  EXPECT_TRUE(state.scene().object(delta.objects[0].id).alive);
}

TEST(Delta, changes_among_the_hidden_are_none) {
  SceneState state = small_state();
  (void)apply_json(
      state, R"([{"op": "replace", "path": "/nodes/Sphere/extensions/KHR_node_visibility/visible", "value": false}])");
  EXPECT_TRUE(
      apply_json(state, R"([{"op": "replace", "path": "/nodes/Sphere/translation", "value": [5, 0, 0]}])").empty());
  (void)apply_json(
      state, R"([{"op": "replace", "path": "/nodes/Sphere/extensions/KHR_node_visibility/visible", "value": true}])");
  EXPECT_EQ(object_of(state.scene(), "Sphere").to_world[3][0], 6);
}

TEST(Delta, a_changed_image_or_sampler_reaches_every_material_that_shows_it) {
  SceneState state = small_state();
  EXPECT_EQ(apply_json(state, R"([{"op": "replace", "path": "/samplers/0/wrapS", "value": 10497}])").materials.size(),
            2U);
  EXPECT_EQ(
      apply_json(state,
                 R"([{"op": "replace", "path": "/images/WoodImage/extras/relook/content", "value": "BumpImage"}])")
          .materials.size(),
      2U);
}

TEST(Delta, a_displacement_follows_its_texture) {
  SceneState state = small_state();
  (void)apply_json(
      state,
      R"([{"op": "add", "path": "/nodes/Sphere/extras", "value": {"relook": {"displacement": {"texture": "Marble"}}}}])");
  const SceneDelta delta = apply_json(
      state, R"([{"op": "replace", "path": "/textures/Marble/extras/relook/procedural/scale", "value": 3}])");
  ASSERT_EQ(delta.objects.size(), 1U);
  EXPECT_EQ(state.scene().object(delta.objects[0].id).displacement->texture.procedural.scale, 3);
  EXPECT_EQ(delta.materials.size(), 1U);
}

/// Random edits, each valid or refused; the names come from a small pool so that they collide.
class RandomEdits {
 public:
  explicit RandomEdits(unsigned seed) : random_(seed) {}

  std::string edit() {
    std::string text = "[" + operation();
    for (unsigned i = below(3); i > 0; --i) text += "," + operation();
    return text + "]";
  }

 private:
  unsigned below(unsigned count) { return static_cast<unsigned>(random_() % count); }
  const char* any(std::initializer_list<const char*> list) {
    return *(list.begin() + below(static_cast<unsigned>(list.size())));
  }
  std::string number() { return std::to_string(below(9)) + "." + std::to_string(below(10)); }
  std::string vector() { return "[" + number() + ", " + number() + ", " + number() + "]"; }
  std::string node() {
    return any({"Group", "Sphere", "Arm", "Hand", "Floor", "Window", "Both", "Lamp", "Sun", "N1", "N2", "N3"});
  }
  std::string material() { return any({"Gold", "Glass", "Mirror", "Phong", "Cut", "M1"}); }

  std::string write(const std::string& op, const std::string& path, const std::string& value) {
    return R"({"op": ")" + op + R"(", "path": ")" + path + R"(", "value": )" + value + "}";
  }
  std::string operation() {
    switch (below(14)) {
      case 0:
        return write("replace", "/nodes/" + node() + "/translation", vector());
      case 1:
        return write("replace", "/nodes/" + node() + "/scale/" + std::to_string(below(3)), number());
      case 2:
        return write("replace", "/nodes/" + node() + "/extensions/KHR_node_visibility/visible", any({"true", "false"}));
      case 3:
        return R"({"op": "remove", "path": "/nodes/)" + node() + "\"}";
      case 4:
        return write(
            "add", "/nodes/" + node(),
            R"({"mesh": ")" + std::string(any({"Ball", "Slab", "Pair"})) + R"(", "translation": )" + vector() + "}");
      case 5:
        return write("add", "/nodes/" + node() + "/children/-", "\"" + node() + "\"");
      case 6:
        return R"({"op": "copy", "from": "/nodes/)" + node() + R"(", "path": "/nodes/)" + node() + "\"}";
      case 7:
        return R"({"op": "move", "from": "/nodes/)" + node() + R"(", "path": "/nodes/)" + node() + "\"}";
      case 8:
        return write("replace", "/materials/" + material() + "/pbrMetallicRoughness/roughnessFactor",
                     "0." + number().substr(0, 1));
      case 9:
        return write("add", "/materials/" + material(), "{}");
      case 10:
        return R"({"op": "remove", "path": "/materials/)" + material() + "\"}";
      case 11:
        return write("replace", "/meshes/" + std::string(any({"Ball", "Slab", "Pair"})) + "/primitives/0/material",
                     "\"" + material() + "\"");
      case 12:
        return write("replace", "/lights/" + std::string(any({"Bulb", "Sunlight", "Cone"})) + "/color", vector());
      default:
        return write("add", "/nodes/" + node() + "/extensions/KHR_lights_punctual",
                     R"({"light": ")" + std::string(any({"Bulb", "Sunlight", "Cone"})) + "\"}");
    }
  }

  std::mt19937 random_;
};

TEST(Incremental, equals_a_compilation_from_scratch_after_random_edits) {
  constexpr unsigned kSeed = 20240229;
  RandomEdits edits(kSeed);
  SceneState state = small_state();
  unsigned applied = 0, refused = 0;
  for (int round = 0; round < 1500; ++round) {
    const std::string edit = edits.edit();
    const Json before = state.document().look;
    const std::string scene_before = scene_text(state.scene());
    try {
      (void)apply_json(state, edit);
      ++applied;
    } catch (const std::exception&) {
      ++refused;
      ASSERT_EQ(state.document().look, before) << "seed " << kSeed << " round " << round << " " << edit;
      ASSERT_EQ(scene_text(state.scene()), scene_before) << edit;
      continue;
    }
    const SceneState fresh(state.document(), state.scene().camera, state.pyramids());
    ASSERT_EQ(scene_text(state.scene()), scene_text(fresh.scene()))
        << "seed " << kSeed << " round " << round << " " << edit;
    for (const auto& item : state.document().look["nodes"].items())
      ASSERT_EQ(state.parent_of(item.key()), fresh.parent_of(item.key())) << edit;
  }
  EXPECT_GT(applied, 200U);
  EXPECT_GT(refused, 200U);
}

}  // namespace
}  // namespace relook
