// KHR_materials_anisotropy and KHR_materials_iridescence: what holds without the oracle (reference_test.cpp) and
// without edits (edit_matrix_test.cpp).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

/// Sets members of one extension of a material.
Json settings(const std::string& material, const std::string& extension, const Json& values) {
  Json operations = Json::array();
  for (const auto& [key, value] : values.items())
    operations.push_back({{"op", "add"},
                          {"path", "/materials/" + material + "/extensions/" + extension + "/" + key},
                          {"value", value}});
  return operations;
}

Frame frame_with(TestScene which, const Json& operations, std::uint32_t max_depth = 4) {
  SceneState state = test_scene(which, 64, 48);
  apply_edit(state, edit_of(operations), "lobes", ".");
  return rendered(state.scene(), {1, max_depth});
}

TEST(Lobes, WithAWeightOfZeroTheRestCountsForNothing) {
  const Json bumps = {{"index", "Bumps"}};
  for (const TestScene which : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    const Frame plain = frame_with(which, Json::array());
    for (const char* material : {"Matte", "Mirror", "Glass"}) {
      SCOPED_TRACE(material);
      EXPECT_TRUE(different_pixels(plain, frame_with(which, settings(material, "KHR_materials_anisotropy",
                                                                     {{"anisotropyRotation", 1},
                                                                      {"anisotropyTexture", bumps}})))
                      .empty());
      EXPECT_TRUE(different_pixels(plain, frame_with(which, settings(material, "KHR_materials_iridescence",
                                                                     {{"iridescenceIor", 1.9},
                                                                      {"iridescenceThicknessMaximum", 700},
                                                                      {"iridescenceTexture", bumps}})))
                      .empty());
    }
  }
}

Frame brushed(double strength, double rotation) {
  Json edit = settings("Matte", "KHR_materials_anisotropy",
                       {{"anisotropyStrength", strength}, {"anisotropyRotation", rotation}});
  edit.push_back(
      {{"op", "replace"}, {"path", "/materials/Matte/pbrMetallicRoughness/roughnessFactor"}, {"value", 0.3}});
  return frame_with(TestScene::spheres, edit, 1);
}
double largest_difference(const Frame& a, const Frame& b) {
  double difference = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      difference = std::max(difference, std::fabs(double{a.pixels[i][c]} - double{b.pixels[i][c]}));
  return difference;
}

TEST(Lobes, ABrushedSurfaceIsTheSameAfterHalfATurn) {
  const Frame frame = brushed(0.8, 0.4);
  EXPECT_LT(largest_difference(frame, brushed(0.8, 0.4 + std::numbers::pi)), 1e-5);
  EXPECT_GT(largest_difference(frame, brushed(0.8, 0.4 + std::numbers::pi / 2)), 0.02);
}

TEST(Lobes, AnisotropyBeginsWhereTheIsotropicLobeEnds) {
  // The smallest strength takes the other formula, and its tangents: the picture is the same to rounding.
  EXPECT_LT(largest_difference(brushed(0, 0.4), brushed(1e-5, 0.4)), 1e-4);
}

/// Of the lobe of a plane under a lamp: towards `lamp` seen from `eye`, both from the origin.
double highlight(Point eye, Point lamp, double rotation) {
  SceneBuilder scene;
  Json material = {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0.3}}}};
  material["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", 0.8}, {"anisotropyRotation", rotation}};
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Brushed", material))}});
  scene.light("Lamp", {{"type", "point"}, {"intensity", 30}}, {{"translation", {lamp.x, lamp.y, lamp.z}}});
  scene.look_at(eye, Point(0, 0, 0), 1, 1, 1);
  return rendered(scene.state().scene(), {1, 1}).pixels.at(0).g;
}

TEST(Lobes, HighlightsAreStretchedAlongTheTangent) {
  // The plane's u runs along +x. Half vectors tilted towards +x see more of the lobe than those towards +z.
  const double along = highlight(Point(0.1F, 3, 0), Point(3, 3, 0), 0);
  const double across = highlight(Point(0, 3, 0.1F), Point(0, 3, 3), 0);
  EXPECT_GT(along, 5 * across);
  EXPECT_NEAR(along, highlight(Point(0, 3, 0.1F), Point(0, 3, 3), std::numbers::pi / 2), 1e-3 * along);
}

/// Reflectance of a rough black dielectric of index 1.5 under a film, seen straight from above: what it returns of
/// ambient light.
Rgba film_seen(double film_ior, double nanometres, double factor = 1) {
  SceneBuilder scene;
  Json material = {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}}};
  material["extensions"]["KHR_materials_iridescence"] = {
      {"iridescenceFactor", factor}, {"iridescenceIor", film_ior}, {"iridescenceThicknessMaximum", nanometres}};
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Film", material))}});
  scene.ambient(Color(1, 1, 1));
  scene.look_at(Point(0, 3, 0.001F), Point(0, 0, 0), 1, 1, 1);
  return rendered(scene.state().scene(), {1, 1}).pixels.at(0);
}

TEST(Lobes, AFilmOfTheBasesOwnIndexIsNotSeen) {
  // But for the product of both reflectances, which the extension keeps at 1e-5 or more: 2 sqrt(1e-5) of a channel.
  const Rgba seen = film_seen(1.5, 700);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 0.04, 0.01);
}

TEST(Lobes, AThickFilmIsTwoSurfaces) {
  // Nothing interferes: R1 + (1 - R1)^2 R2 / (1 - R1 R2).
  const double r1 = std::pow(0.7 / 2.7, 2), root = std::sqrt(0.04 + 1e-4), base = (1 + root) / (1 - root);
  const double r2 = std::pow((base - 1.7) / (base + 1.7), 2);
  const Rgba seen = film_seen(1.7, 60000);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], r1 + std::pow(1 - r1, 2) * r2 / (1 - r1 * r2), 1e-5);
}

TEST(Lobes, AQuarterWaveOfTheRightIndexTakesTheReflectionAway) {
  // Of the square root of the base's index, a quarter of 550 nm thick: the coating of lenses. Half a wave is none.
  const double ior = std::sqrt(1.5), quarter = 550 / (4 * ior);
  EXPECT_NEAR(film_seen(ior, quarter, 0).g, 0.04, 1e-5);
  EXPECT_LT(film_seen(ior, quarter).g, 0.01);
  EXPECT_NEAR(film_seen(ior, 2 * quarter).g, 0.04, 0.01);
  EXPECT_GT(film_seen(ior, quarter).b, film_seen(ior, quarter).g);
}

}  // namespace
}  // namespace relook
