// What real scenes ask of surfaces and rays: decals, back faces, the camera's planes, places far from the origin, maps
// that are turned. Each expected value follows from the scene alone.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/look/look_warnings.h"
#include "test_scenes.h"

namespace relook {
namespace {

constexpr float kExact = 1e-6F;

Json unlit(Rgba color, bool is_double_sided = true) {
  Json material = {{"pbrMetallicRoughness", {{"baseColorFactor", {color.r, color.g, color.b, color.a}}}},
                   {"doubleSided", is_double_sided}};
  material["extensions"]["KHR_materials_unlit"] = Json::object();
  if (color.a < 1) material["alphaMode"] = "BLEND";
  return material;
}

Json lambert() {
  Json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}};
  material["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
  return material;
}

int card(SceneBuilder& scene, const std::string& name, float half_size, Json material, Json placement) {
  placement["mesh"] = scene.mesh(name, card_mesh(half_size, half_size), scene.material(name, std::move(material)));
  return scene.node(name, std::move(placement));
}

Rgba middle(SceneBuilder& scene) {
  scene.look_at(Point(0, 0, 3), Point(0, 0, 0), 40, 1, 1);
  return rendered(scene.state().scene(), {1, 6}).pixels.at(0);
}

void expect_color(const Rgba& seen, const Rgba& wanted) {
  for (int channel = 0; channel < 4; ++channel) EXPECT_NEAR(seen[channel], wanted[channel], kExact) << channel;
}

// The ray meets the middle of both cards, where their triangles share an edge: each is one surface there.
TEST(Surfaces, a_decal_blends_over_a_wall_however_near_it_lies) {
  for (const double distance : {0.0, 1e-7, 5e-4, 0.01})
    for (const bool is_swapped : {false, true}) {
      SCOPED_TRACE(std::to_string(distance) + (is_swapped ? " swapped" : ""));
      SceneBuilder scene;
      card(scene, is_swapped ? "B" : "A", 1, unlit(Rgba(1, 0, 0, 1)), Json::object());
      card(scene, is_swapped ? "A" : "B", 0.5F, unlit(Rgba(1, 1, 1, 0.5F)), {{"translation", {0, 0, distance}}});
      expect_color(middle(scene), Rgba(1, 0.5F, 0.5F, 1));
    }
}

TEST(Surfaces, blended_surfaces_that_coincide_all_count) {
  SceneBuilder scene;
  card(scene, "Wall", 1, unlit(Rgba(1, 0, 0, 1)), Json::object());
  for (const char* name : {"First", "Second", "Third"})
    card(scene, name, 0.5F, unlit(Rgba(1, 1, 1, 0.5F)), Json::object());
  expect_color(middle(scene), Rgba(1, 0.875F, 0.875F, 1));
}

TEST(Surfaces, a_wall_behind_a_coplanar_decal_never_shows_what_is_behind_it) {
  const Json tilted = {{"rotation", {0.2705981, 0.2705981, 0.0, 0.9238795}}};
  SceneBuilder scene;
  card(scene, "Wall", 2, unlit(Rgba(1, 0, 0, 1)), tilted);
  card(scene, "Decal", 1.3F, unlit(Rgba(1, 1, 1, 0.5F)), tilted);
  scene.look_at(Point(0, 0, 4), Point(0, 0, 0), 20, 24, 24);
  for (const Rgba& pixel : rendered(scene.state().scene(), {1, 6}).pixels) EXPECT_EQ(pixel.a, 1);
}

TEST(Surfaces, back_faces_of_single_sided_materials_are_not_there) {
  const Json turned = {{"rotation", {0, 1, 0, 0}}};
  for (const bool is_double_sided : {false, true}) {
    SceneBuilder scene;
    card(scene, "Card", 1, unlit(Rgba(1, 0, 0, 1), is_double_sided), turned);
    card(scene, "Behind", 1, unlit(Rgba(0, 1, 0, 1)), {{"translation", {0, 0, -1}}});
    expect_color(middle(scene), is_double_sided ? Rgba(1, 0, 0, 1) : Rgba(0, 1, 0, 1));
  }
}

TEST(Surfaces, single_sided_ones_cast_shadows_where_they_face_the_light) {
  for (const bool faces_light : {false, true})
    for (const bool is_double_sided : {false, true}) {
      SceneBuilder scene;
      card(scene, "Wall", 1, lambert(), Json::object());
      Json blocker = {{"translation", {1, 0, 1}}, {"scale", {0.3, 0.3, 0.3}}};
      if (!faces_light) blocker["rotation"] = {0, 1, 0, 0};
      card(scene, "Blocker", 1, unlit(Rgba(0, 1, 0, 1), is_double_sided), blocker);
      scene.light("Sun", {{"type", "directional"}, {"intensity", std::numbers::pi}},
                  {{"rotation", {0, 0.3826834, 0, 0.9238795}}});  // from +x and +z
      const float lit = faces_light || is_double_sided ? 0.0F : std::numbers::sqrt2_v<float> / 2;
      EXPECT_NEAR(middle(scene).r, lit, 1e-5F) << faces_light << is_double_sided;
    }
}

TEST(Surfaces, a_place_far_from_the_origin_is_like_one_at_it) {
  const auto frame_at = [](double far) {
    SceneBuilder scene;
    const int ball = scene.mesh("Ball", sphere_mesh(0.25F, 24, 16), scene.material("Ball", lambert()));
    scene.node("Ball", {{"mesh", ball}, {"translation", {far, 0.25, far}}});
    scene.node("Floor", {{"mesh", scene.mesh("Floor", plane_mesh(1, 1), scene.material("Floor", lambert()))},
                         {"translation", {far, 0, far}}});
    scene.light("Lamp", {{"type", "point"}, {"intensity", 5}}, {{"translation", {far + 1, 1.5, far + 1}}});
    const auto at = static_cast<float>(far);
    scene.look_at(Point(at + 1, 1, at + 2), Point(at, 0.25F, at), 40, 24, 24);
    return rendered(scene.state().scene(), {1, 6});
  };
  EXPECT_TRUE(different_pixels(frame_at(0), frame_at(1 << 19)).empty());
}

TEST(Surfaces, nothing_is_seen_before_the_near_plane_or_behind_the_far_one) {
  SceneBuilder scene;
  card(scene, "Near", 0.5F, unlit(Rgba(1, 0, 0, 1)), {{"translation", {0, 0, 2}}});
  card(scene, "Middle", 1, unlit(Rgba(0, 1, 0, 0.5F)), Json::object());
  card(scene, "Far", 9, unlit(Rgba(0, 0, 1, 1)), {{"translation", {0, 0, -2}}});
  scene.look_at(Point(0, 0, 3), Point(0, 0, 0), 40, 1, 1);
  const SceneState state = scene.state();
  const auto seen = [&](float near, float far) {
    Camera camera = state.scene().camera;
    camera.near = near;
    camera.far = far;
    return rendered(with_camera(state, camera).scene(), {1, 6}).pixels.at(0);
  };
  const float all = std::numeric_limits<float>::infinity();
  expect_color(seen(0, all), Rgba(1, 0, 0, 1));
  expect_color(seen(1.5F, all), Rgba(0, 0.5F, 0.5F, 1));
  expect_color(seen(1.5F, 4), Rgba(0, 0.5F, 0, 0.5F));
  expect_color(seen(3.5F, 4), Rgba(0, 0, 0, 0));
}

// The map leans 45 degrees towards +u, and the light comes from there.
TEST(Surfaces, the_frame_of_a_normal_map_turns_and_mirrors_with_the_map) {
  constexpr TexelFunction kLeaning = [](std::uint32_t, std::uint32_t) { return Rgba(0.853553F, 0.5F, 0.853553F, 1); };
  const auto light_on = [&](const Json& transform) {
    SceneBuilder scene;
    const int texture = scene.texture("Leaning", scene.image("Leaning", single_level_image(4, kLeaning)));
    Json material = lambert();
    material["normalTexture"] = {{"index", texture}, {"extensions", {{"KHR_texture_transform", transform}}}};
    card(scene, "Card", 1, material, Json::object());
    scene.light("Sun", {{"type", "directional"}, {"intensity", std::numbers::pi}},
                {{"rotation", {0, 0.3826834, 0, 0.9238795}}});
    return middle(scene).r;
  };
  const double quarter = std::numbers::pi / 2;
  EXPECT_NEAR(light_on({{"scale", {2, 3}}}), 1, 1e-3F);
  EXPECT_NEAR(light_on({{"rotation", quarter}}), 0.5, 1e-3F);
  EXPECT_NEAR(light_on({{"rotation", 2 * quarter}}), 0, 1e-3F);
  EXPECT_NEAR(light_on({{"scale", {-1, 1}}}), 0, 1e-3F);
  EXPECT_NEAR(light_on({{"scale", {1, -1}}}), 1, 1e-3F);
}

// As a limit: a body that grows thinner and thinner looks like the sheet that it ends as.
TEST(Surfaces, what_is_scaled_to_nothing_along_one_axis_is_a_sheet) {
  const std::vector<Json> scales{{0.7, 0.9, 0.0}, {0.7, 0.0, 0.9}, {0.0, 0.7, 0.9}, {-0.7, 0.9, 0.0}};
  const Json turn = {0.2705981, 0.3, 0.1, 0.9};
  for (const Json& scale : scales)
    for (const bool is_smooth : {false, true}) {
      SCOPED_TRACE(scale.dump());
      const auto frame = [&](double least) {
        Json thick = scale;
        for (Json& part : thick)
          if (part == 0.0) part = least;
        SceneBuilder scene;
        Mesh mesh = sphere_mesh(0.5F, 12, 8);
        if (!is_smooth) mesh.normals.clear();
        const int ball = scene.mesh("Ball", std::move(mesh), scene.material("White", lambert()));
        scene.node("Ball", {{"mesh", ball}, {"scale", thick}, {"rotation", turn}});
        scene.light("Lamp", {{"type", "point"}, {"intensity", 60}}, {{"translation", {1, 2, 3}}});
        scene.look_at(Point(0, 0, 3), Point(0, 0, 0), 40, 16, 16);
        return rendered(scene.state().scene(), {1, 6}).pixels;
      };
      const std::vector<Rgba> sheet = frame(0), thin = frame(1e-6);
      std::size_t covered = 0;
      for (std::size_t i = 0; i < sheet.size(); ++i) {
        covered += sheet[i].a > 0 ? 1 : 0;
        if (sheet[i].a != thin[i].a) continue;  // the outline's own pixels
        for (int channel = 0; channel < 4; ++channel) EXPECT_NEAR(sheet[i][channel], thin[i][channel], 1e-3F) << i;
      }
      EXPECT_GT(covered, 3U);
    }
}

Frame lit_automatically(const SceneBuilder& scene, std::string& said) {
  LookDocument document = scene.state().document();
  said = add_auto_lights(document, scene.camera());
  return rendered(SceneState(std::move(document), scene.camera(), nullptr).scene(), {1, 6});
}

TEST(Surfaces, a_closed_room_gets_a_lamp_and_an_open_one_does_not) {
  for (const bool is_closed : {true, false}) {
    SceneBuilder scene;
    Mesh room = is_closed ? box_mesh(Point(2, 2, 2)) : plane_mesh(2, 1);
    Json inside = lambert();
    inside["doubleSided"] = true;
    const int mesh = scene.mesh("Room", std::move(room), scene.material("Wall", inside));
    scene.node("Room", {{"mesh", mesh}, {"translation", {0, is_closed ? 0 : -1, 0}}});
    card(scene, "Post", 0.5F, lambert(), {{"translation", {0, 0, -1.5}}});
    scene.look_at(Point(0, 0, 1), Point(0, 0, 0), 60, 8, 8);
    std::string said;
    const Frame frame = lit_automatically(scene, said);
    EXPECT_EQ(said.find("node \"Room\"") != std::string::npos, is_closed) << said;
    const Rgba& post = frame.pixels.at(8 * 4 + 4);
    EXPECT_GT(post.g, 0.2F);
    EXPECT_LT(post.g, 1.5F);
  }
}

TEST(Surfaces, what_cannot_be_seen_is_named) {
  SceneBuilder scene;
  card(scene, "Line", 1, lambert(), {{"scale", {1, 0, 0}}});
  card(scene, "Sheet", 1, lambert(), {{"scale", {0, 1, 1}}});
  scene.light("Torch", {{"type", "spot"}, {"spot", Json::object()}}, {{"scale", {0, 0, 0}}});
  scene.light("Bulb", {{"type", "point"}}, {{"scale", {0, 0, 0}}});
  Json textured = lambert();
  textured["pbrMetallicRoughness"]["baseColorTexture"] = {
      {"index", scene.procedural_texture("Nothing", {{"kind", "noise"}})}};
  card(scene, "Page", 1, textured, {{"translation", {0, 0, -1}}});
  scene.look_at(Point(0, 0, 1), Point(0, 0, 0), 60, 8, 8);
  LookDocument document = scene.state().document();
  document.look["textures"]["Nothing"].erase("extras");
  const std::vector<std::string> warnings = look_warnings(document);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_NE(warnings[0].find("\"Line\""), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("\"Torch\""), std::string::npos) << warnings[1];
  EXPECT_NE(warnings[2].find("\"Page\""), std::string::npos) << warnings[2];
}

// No cut-off by what the ior reflects where the colour reflects more (KHR_materials_specular, ior 0).
TEST(Surfaces, an_ior_of_0_mirrors_its_colour_whether_it_transmits_or_not) {
  for (const double transmission : {0.0, 1.0}) {
    SceneBuilder scene;
    Json material = {{"pbrMetallicRoughness",
                      {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}}}};
    material["extensions"] = {{"KHR_materials_ior", {{"ior", 0}}},
                              {"KHR_materials_specular", {{"specularColorFactor", {0.8, 0.8, 0.8}}}},
                              {"KHR_materials_transmission", {{"transmissionFactor", transmission}}}};
    card(scene, "Card", 1, material, Json::object());
    scene.environment({{"color", {0, 1, 0}}});
    expect_color(middle(scene), Rgba(0, 0.8F, 0, 1));
  }
}

}  // namespace
}  // namespace relook
