// The pictures of the integrator `path` against the small path tracer of tests/oracle, which estimates the same light
// by other techniques: the differences of 256 pixels have a mean of zero, and those of each quarter, too.
#include <gtest/gtest.h>

#include <array>

#include "color/physics_scenes.h"
#include "path_reference.h"
#include "path_studio.h"

namespace relook {
namespace {

/// Quarters of a picture of 16 x 16, then all of it.
constexpr std::size_t kParts = 5;

/// Differences with the oracle are zero but for noise.
void expect_reference(const PathStudio& scene, const std::string& what, unsigned samples = 64,
                      unsigned diffuse_depth = 0) {
  const SceneState state = scene.path_state();
  const std::vector<Vec> program = colors_of(scene.frame(samples, 6, diffuse_depth));
  const std::vector<PathReference::Pixel> oracle = PathReference(state.scene(), diffuse_depth).pixels(samples, 26);
  ASSERT_EQ(program.size(), oracle.size());
  std::array<std::vector<Vec>, kParts> differences, expected;
  const std::size_t width = state.scene().camera.width;
  for (std::size_t i = 0; i < program.size(); ++i) {
    const std::size_t quarter = (i % width < width / 2 ? 0U : 1U) + (i / width < width / 2 ? 0U : 2U);
    for (const std::size_t part : {quarter, kParts - 1}) {
      differences[part].push_back(program[i] - oracle[i].mean);
      expected[part].push_back(oracle[i].mean);
    }
  }
  for (std::size_t part = 0; part < kParts; ++part) {
    const Measured of_oracle = measured(expected[part]), difference = measured(differences[part]);
    const Measured both{of_oracle.mean + difference.mean, difference.error};
    expect_measured(both, of_oracle.mean, what + ", part " + std::to_string(part), 2e-3);
  }
  EXPECT_GT(measured(expected.back()).mean.y, 1e-3) << what << " is black";
}

Json surface(double metallic, double roughness) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {0.8, 0.6, 0.3, 1}}, {"metallicFactor", metallic}, {"roughnessFactor", roughness}}},
          {"doubleSided", true}};
}

/// A floor and a ball of a material, seen from above.
PathStudio ball_studio(const Json& material, const Json& floor = lambert(0.5)) {
  PathStudio scene;
  scene.node("Floor", {{"mesh", scene.mesh("Floor", plane_mesh(4, 1), scene.material("Floor", floor))}});
  scene.node("Ball", {{"mesh", scene.mesh("Ball", sphere_mesh(1, 16, 8), scene.material("Ball", material))},
                      {"translation", {0, 1, 0}}});
  scene.look_at(Point(0, 2.5F, 5), Point(0, 0.8F, 0), 36, 16, 16);
  return scene;
}
void add_window(PathStudio& scene, double nits = 10) {
  Json light = {{"type", "rect"}, {"intensity", nits}, {"size", 1.5}};
  scene.area("Window", light, {{"translation", {2, 3, 1}}, {"rotation", shining({-2, -2, -1})}});
}
void add_sky_with_sun(PathStudio& scene) {
  scene.environment({{"color", {1, 1, 1}}});
  scene.image("Sky", single_level_image(8, [](std::uint32_t x, std::uint32_t y) {
                return x == 2 && y == 1 ? Rgba(40, 30, 20, 1) : Rgba(0.2F, 0.3F, y < 4 ? 0.8F : 0.1F, 1);
              }));
  scene.sky_image("Sky");
}

constexpr std::array kRoughnesses{0.05, 0.2, 0.5, 0.75, 1.0};

TEST(PathReference, a_rectangle_lights_surfaces_of_any_roughness) {
  for (const double roughness : kRoughnesses)
    for (const double metallic : {0.0, 1.0}) {
      PathStudio scene = ball_studio(surface(metallic, roughness), surface(1 - metallic, roughness));
      add_window(scene);
      expect_reference(scene, "metallic " + std::to_string(metallic) + ", roughness " + std::to_string(roughness));
    }
}

TEST(PathReference, sky_and_suns_light_surfaces_of_any_roughness) {
  for (const double roughness : kRoughnesses) {
    PathStudio scene = ball_studio(surface(0, roughness), surface(1, roughness));
    add_sky_with_sun(scene);
    expect_reference(scene, "roughness " + std::to_string(roughness));
  }
}

TEST(PathReference, every_kind_of_light_at_once) {
  PathStudio scene = ball_studio(surface(0.5, 0.4));
  scene.area("Disk", {{"type", "disk"}, {"intensity", 4}, {"size", 1}},
             {{"translation", {-2, 2, 1}}, {"rotation", shining({2, -1, -1})}});
  Json bulb = {{"type", "point"}, {"intensity", 8}}, spot = {{"type", "spot"}, {"intensity", 20}},
       sun = {{"type", "directional"}, {"intensity", 1}};
  bulb["extras"]["relook"]["radius"] = 0.3;
  sun["extras"]["relook"]["angle"] = 0.2;
  scene.light("Bulb", bulb, {{"translation", {1.5, 0.8, 1.5}}});
  scene.light("Spot", spot, {{"translation", {0, 4, 0.5}}, {"rotation", shining({0, -1, 0})}});
  scene.light("Sun", sun, {{"rotation", shining({1, -2, -1})}});
  Json glow = lambert(0.2);
  glow["emissiveFactor"] = {1, 0.5, 0.2};
  glow["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 3;
  scene.node("Card", {{"mesh", scene.mesh("Card", card_mesh(0.6F, 0.4F), scene.material("Glow", glow))},
                      {"translation", {-1.5, 1, 1}},
                      {"rotation", shining({-1, 0, -0.5})}});
  expect_reference(scene, "all lights");
}

TEST(PathReference, coats_over_rough_and_smooth_bases) {
  for (const double roughness : {0.1, 0.7}) {
    Json material = surface(0, 0.8 - roughness);
    material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.8},
                                                         {"clearcoatRoughnessFactor", roughness}};
    PathStudio scene = ball_studio(material);
    add_window(scene);
    scene.environment({{"color", {0.2, 0.4, 0.6}}});
    expect_reference(scene, "coat roughness " + std::to_string(roughness));
  }
}

TEST(PathReference, glass_before_a_window_and_under_a_sky) {
  for (const double roughness : {0.0, 0.3, 0.8}) {
    Json material = glass(1.5, 1);
    material["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
    material["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 2;
    material["extensions"]["KHR_materials_volume"]["attenuationColor"] = {0.9, 0.5, 0.3};
    PathStudio scene = ball_studio(material, surface(0, 0.4));
    add_window(scene);
    scene.environment({{"color", {0.3, 0.3, 0.3}}});
    expect_reference(scene, "glass of roughness " + std::to_string(roughness));
  }
}

TEST(PathReference, thin_filters_and_blended_cards_before_a_window) {
  Json filter = glass(1.4, 0), card = lambert(0.7);
  filter["doubleSided"] = card["doubleSided"] = true;
  filter["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0.6, 0.2, 1};
  filter["pbrMetallicRoughness"]["roughnessFactor"] = 0.3;
  card["alphaMode"] = "BLEND";
  card["pbrMetallicRoughness"]["baseColorFactor"] = {0.7, 0.2, 0.2, 0.4};
  PathStudio scene = ball_studio(surface(1, 0.6));
  scene.node("Filter", {{"mesh", scene.mesh("Filter", card_mesh(0.8F, 0.8F), scene.material("Filter", filter))},
                        {"translation", {1.2, 2, 0.6}},
                        {"rotation", shining({-2, -2, -1})}});
  scene.node("Card", {{"mesh", scene.mesh("Card", card_mesh(0.8F, 0.8F), scene.material("Card", card))},
                      {"translation", {-1, 1.5, 1.5}}});
  add_window(scene);
  scene.environment({{"color", {0.3, 0.3, 0.3}}});
  expect_reference(scene, "filters");
}

TEST(PathReference, rough_panes_before_lamps_and_windows) {
  // Seen by the eye, by a mirror and by what scatters, of a lamp without size and of a window, across bounces.
  for (const double roughness : {0.2, 0.8})
    for (const double thickness : {0.0, 1.0}) {
      Json pane = glass(1.5, thickness);
      pane["doubleSided"] = true;
      pane["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
      pane["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.7, 0.4, 1};
      pane["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.8;
      PathStudio scene = ball_studio(surface(1, 0.1), surface(0.2, 0.6));
      const Mesh mesh = thickness > 0 ? box_mesh(Point(0.9F, 0.9F, 0.1F)) : card_mesh(0.9F, 0.9F);
      scene.node("Pane", {{"mesh", scene.mesh("Pane", mesh, scene.material("Pane", pane))},
                          {"translation", {0.9, 1, 1.6}},
                          {"rotation", shining({-0.3, 0, -1})}});
      add_window(scene);
      scene.light("Lamp", {{"type", "point"}, {"intensity", 12}}, {{"translation", {0.8, 1.2, -1.5}}});
      scene.environment({{"color", {0.1, 0.2, 0.4}}});
      expect_reference(scene, "roughness " + std::to_string(roughness) + ", thickness " + std::to_string(thickness), 64,
                       1);
    }
}

TEST(PathReference, diffuse_bounces_in_a_corner_of_gloss_and_glass) {
  for (const unsigned bounces : {1U, 3U}) {
    PathStudio scene = ball_studio(glass(1.5, 1), surface(0.3, 0.5));
    Json wall = surface(0, 0.7);
    wall["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.3, 0.2, 1};
    scene.node("Wall", {{"mesh", scene.mesh("Wall", card_mesh(3, 2), scene.material("Wall", wall))},
                        {"translation", {0, 2, -1.3}}});
    add_window(scene);
    scene.environment({{"color", {0.1, 0.2, 0.4}}});
    expect_reference(scene, std::to_string(bounces) + " bounces", 64, bounces);
  }
}

TEST(PathReference, facing_metals_pass_light_on_until_the_last_reflection) {
  for (const double roughness : {0.1, 0.4, 0.7}) {
    PathStudio scene = ball_studio(surface(1, roughness), surface(1, roughness));
    scene.node("Wall", {{"mesh", scene.mesh("Wall", card_mesh(2, 2), scene.material("Wall", surface(1, 0.3)))},
                        {"translation", {0, 2, -1.5}}});
    add_window(scene);
    scene.environment({{"color", {0.1, 0.2, 0.4}}});
    expect_reference(scene, "roughness " + std::to_string(roughness));
  }
}

}  // namespace
}  // namespace relook
