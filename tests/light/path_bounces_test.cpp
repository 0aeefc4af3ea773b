// Light between diffuse surfaces: with N bounces N + 1 vertices scatter, so closed forms are series of as many terms.
#include <gtest/gtest.h>

#include <cmath>

#include "color/physics_scenes.h"
#include "path_studio.h"

namespace relook {
namespace {

constexpr double kAlbedo = 0.8;

Json shining_plate(double nits) {
  Json material = lambert(kAlbedo);
  material["emissiveFactor"] = {nits, nits, nits};
  material["doubleSided"] = true;
  return material;
}

/// A place on the lower one of two wide plates, a metre apart, of which the upper one shines with a radiance of 1.
Measured lower_plate(std::uint32_t bounces, std::uint32_t max_depth = 8) {
  PathStudio scene;
  scene.node("Lower", {{"mesh", scene.mesh("Lower", plane_mesh(60, 1), scene.material("Dark", shining_plate(0)))}});
  scene.node("Upper", {{"mesh", scene.mesh("Upper", plane_mesh(60, 1), scene.material("Light", shining_plate(1)))},
                       {"translation", {0, 1, 0}}});
  return scene.seen(Point(0.4F, 0.5F, 0), Point(0, 0, 0), 64, max_depth, bounces);
}
/// rho + rho^3 + rho^5...: light goes up and down between scatterings at the lower plate.
Vec of_plates(std::uint32_t vertices) {
  double sum = 0;
  for (std::uint32_t k = 1; k <= vertices; k += 2) sum += std::pow(kAlbedo, k);
  return {sum, sum, sum};
}

TEST(PathBounces, facing_plates_add_every_other_power_of_their_albedo) {
  for (const std::uint32_t bounces : {0U, 1U, 2U, 3U, 4U}) {
    const std::string name = std::to_string(bounces) + " bounces";
    // The far ends of the plates, 60 m away, let out about 1 / 3600 at each vertex.
    expect_measured(lower_plate(bounces), of_plates(bounces + 1), name, 3e-3);
  }
}

TEST(PathBounces, the_depth_of_all_rays_ends_bounces_too) {
  // A ray from a vertex at the last generation gathers.
  expect_measured(lower_plate(4, 2), of_plates(2), "depth 2", 3e-3);
  expect_measured(lower_plate(4, 3), of_plates(3), "depth 3", 3e-3);
}

TEST(PathBounces, surfaces_are_passed_as_often_as_the_depth_of_transmission_says) {
  // Behind as many panes of no index more than the depth a ray still brings what shines, and nothing that is lit.
  for (const bool is_unlit : {false, true})
    for (const std::uint32_t depth : {0U, 1U, 2U, 3U}) {
      PathStudio scene;
      scene.node("Card", {{"mesh", scene.mesh("Card", card_mesh(4, 4),
                                              scene.material("Card", is_unlit ? unlit(0.5, 0.5, 0.5) : lambert(0.5)))}});
      const int pane = scene.mesh("Pane", card_mesh(4, 4), scene.material("Pane", glass(1, 0)));
      for (const double z : {1.0, 1.5}) scene.node("Pane" + std::to_string(z), {{"mesh", pane}, {"translation", {0, 0, z}}});
      scene.light("Sun", {{"type", "directional"}, {"intensity", kPi}}, {{"rotation", shining({0, 0, -1})}});
      scene.look_at(Point(0, 0, 3), Point(0, 0, 0), 1, 1, 1);
      ViewOptions view;
      view.integrator = Integrator::path;
      view.transmission_depth = depth;
      const Rgba seen = rendered(scene.path_state().scene(), view).pixels.at(0);
      EXPECT_NEAR(seen.r, is_unlit || depth >= 2 ? 0.5 : 0, 1e-4) << "depth " << depth << (is_unlit ? ", unlit" : "");
    }
}

TEST(PathBounces, a_room_that_shines_is_brighter_by_a_power_of_its_albedo_for_each_bounce) {
  // Every ray ends on a wall of radiance 1: the sum of rho^k up to N + 1.
  for (const std::uint32_t bounces : {0U, 1U, 2U, 5U}) {
    PathStudio scene;
    scene.node("Room", {{"mesh", scene.mesh("Room", box_mesh(Point(1, 1, 1)), scene.material("Wall", shining_plate(1)))}});
    const double expected = (1 - std::pow(kAlbedo, bounces + 2)) / (1 - kAlbedo);
    expect_measured(scene.seen(Point(0.3F, 0.2F, 0), Point(-0.2F, -1, 0.1F), 64, 8, bounces),
                    Vec(expected, expected, expected), std::to_string(bounces) + " bounces");
  }
}

TEST(PathBounces, no_bounce_makes_a_white_room_brighter_than_its_light) {
  // A furnace: white walls around a point under a hole of radiance 1 reflect at most what comes in.
  PathStudio scene;
  scene.node("Floor", {{"mesh", scene.mesh("Floor", plane_mesh(2, 1), scene.material("Floor", lambert(1)))}});
  scene.node("Wall", {{"mesh", scene.mesh("Wall", card_mesh(2, 1), scene.material("Wall", [] {
                         Json both = lambert(1);
                         both["doubleSided"] = true;
                         return both;
                       }()))},
                      {"translation", {0, 1, -0.5}}});
  add_white_sky(scene);
  const Measured seen = scene.seen(Point(0, 1, 2), Point(0, 0, 0), 64, 8, 6);
  expect_no_gain(seen, "corner");
  EXPECT_GT(seen.mean.x, 0.9);
}

}  // namespace
}  // namespace relook
