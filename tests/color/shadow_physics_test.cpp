// Closed forms of what stands between a surface and its lights, and of all lights together: each expected value is
// derived beside it, from optics alone.
#include <gtest/gtest.h>

#include <cmath>

#include "physics_scenes.h"

namespace relook {
namespace {

/// A Lambert plane under a vertical sun of pi lux: radiance 1 where nothing stands between.
SceneBuilder sunlit_plane() {
  SceneBuilder scene;
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1.0)))}});
  scene.light("Sun", {{"type", "directional"}, {"intensity", kPi}}, {{"rotation", shining({0, -1, 0})}});
  return scene;
}
void add_roof(SceneBuilder& scene, const std::string& name, double height, const Json& material) {
  const int mesh = scene.mesh(name, plane_mesh(1, 1), scene.material(name, material));
  scene.node(name, {{"mesh", mesh}, {"translation", {0.2, height, 0.1}}});
}
/// Seen from the side, below the roofs.
Rgba seen_below_roofs(SceneBuilder& scene) { return seen(scene, Point(0, 0.5F, 3), Point(0, 0, 0), 1); }

TEST(Physics, OpaqueBlockerCastsABlackShadow) {
  SceneBuilder scene = sunlit_plane();
  expect_near(seen_below_roofs(scene), 1, 1, 1);
  add_roof(scene, "Roof", 2, lambert(0.5));
  expect_near(seen_below_roofs(scene), 0, 0, 0);
}

TEST(Physics, TransparentBlockersTintTheShadowOneAfterTheOther) {
  SceneBuilder scene = sunlit_plane();
  Json stained = glass(1.5, 0);  // thin: transmission * base, from either side
  stained["doubleSided"] = true;
  stained["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.5, 0.2, 1};
  stained["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.5;
  SceneBuilder turned = scene;
  add_roof(scene, "Stained", 2, stained);
  expect_near(seen_below_roofs(scene), 0.45, 0.25, 0.1);
  const int pane = turned.mesh("Stained", plane_mesh(1, 1), turned.material("Stained", stained));
  turned.node("Stained", {{"mesh", pane}, {"translation", {0.2, 2, 0.1}}, {"rotation", {1, 0, 0, 0}}});
  expect_near(seen_below_roofs(turned), 0.45, 0.25, 0.1);
  Json veil = lambert(0.3);  // 1 - coverage
  veil["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.6;
  veil["alphaMode"] = "BLEND";
  add_roof(scene, "Veil", 3, veil);
  expect_near(seen_below_roofs(scene), 0.45 * 0.4, 0.25 * 0.4, 0.1 * 0.4);
  add_roof(scene, "Opaque", 4, lambert(0.3));
  expect_near(seen_below_roofs(scene), 0, 0, 0);
}

TEST(Physics, LightThroughAVolumeIsAttenuatedOverTheWayInside) {
  // Down through a box of height 0.5: base on the way in, 1 on the way out, Beer over 0.5.
  SceneBuilder scene = sunlit_plane();
  Json tinted = glass(1.5, 1);
  tinted["pbrMetallicRoughness"]["baseColorFactor"] = {0.8, 0.8, 0.8, 1};
  tinted["extensions"]["KHR_materials_volume"]["attenuationColor"] = {0.25, 0.5, 1};
  tinted["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 1;
  const int box = scene.mesh("Box", box_mesh(Point(1, 0.25F, 1)), scene.material("Glass", tinted));
  scene.node("Box", {{"mesh", box}, {"translation", {0.2, 2, 0.1}}});
  expect_near(seen_below_roofs(scene), 0.8 * 0.5, 0.8 * std::sqrt(0.5), 0.8);
}

TEST(Physics, CutOutLetsLightThroughItsHoles) {
  for (const float alpha : {0.0F, 1.0F}) {
    SceneBuilder scene = sunlit_plane();
    Json leaf = lambert(0.5);
    leaf["pbrMetallicRoughness"]["baseColorFactor"][3] = alpha;
    leaf["alphaMode"] = "MASK";
    add_roof(scene, "Leaf", 2, leaf);
    const double lit = 1.0 - alpha;
    expect_near(seen_below_roofs(scene), lit, lit, lit);
  }
}

/// Radiance of a plane under a white furnace of lamps: 20 x 40 directional lights of equal solid angle.
double furnace(const Json& material, double view_degrees) {
  SceneBuilder scene;
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Under test", material))}});
  const int rings = 20, turns = 40;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < turns; ++j) {
      const double height = (i + 0.5) / rings, turn = 2 * kPi * (j + 0.5) / turns, out = std::sqrt(1 - height * height);
      scene.light("Sun" + std::to_string(i * turns + j),
                  {{"type", "directional"}, {"intensity", 2 * kPi / (rings * turns)}},
                  {{"rotation", shining({-out * std::cos(turn), -height, -out * std::sin(turn)})}});
    }
  }
  const double angle = view_degrees * kPi / 180;
  return seen(scene, Point(static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)), 0), Point(0, 0, 0),
              1)
      .g;
}

TEST(Physics, WhiteFurnaceReturnsNoMoreThanItSends) {
  Json dielectric = lambert(1.0), coated = lambert(1.0), velvet = lambert(1.0), rough_metal = metal(0.5), rougher = metal(1),
       brushed = metal(0.5);
  dielectric["extensions"].erase("KHR_materials_specular");
  dielectric["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
  coated["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.5}};
  velvet["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 0.5}};
  brushed["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 0.5}};
  for (const double view : {5.0, 45.0}) {
    SCOPED_TRACE(view);
    EXPECT_NEAR(furnace(lambert(1.0), view), 1, 0.005);  // all of it comes back: the integral of cos / pi
    for (const Json& material : {dielectric, coated, velvet, rough_metal, rougher, brushed})
      EXPECT_LE(furnace(material, view), 1.015);
    for (const Json& material : {dielectric, coated, velvet}) EXPECT_GE(furnace(material, view), 0.85);
  }
  // Towards grazing glTF's mix is not conserving: it weighs the diffuse part by 1 - F(V.H) light by light, which does
  // not know how much the whole specular lobe returns. A few per cent, and no more.
  EXPECT_LE(furnace(dielectric, 75), 1.07);
  // Single scattering alone: a smooth lobe loses little.
  EXPECT_GE(furnace(rough_metal, 5), 0.9);
  EXPECT_NEAR(furnace(brushed, 5), 0.777, 0.01);  // the integral of that lobe by a program of its own
}

TEST(Physics, SurfaceDoesNotShadowItselfWhereCoordinatesVanish) {
  // A hit at the origin of all coordinates on a triangle of 10 metres: rounding follows the triangle, not the point.
  SceneBuilder scene = sunlit_plane();
  for (const Point& eye : {Point(0, 0.5F, 3), Point(0, 1, 0.1F), Point(2, 0.3F, 1)})
    expect_near(seen(scene, eye, Point(0, 0, 0), 1), 1, 1, 1);
}

TEST(Physics, AmbientLightOnWhiteIsTheAmbientLight) {
  SceneBuilder scene;
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1.0)))}});
  scene.ambient(Color(0.25F, 0.5F, 0.75F));
  expect_near(seen(scene, Point(0, 3, 1), Point(0, 0, 0)), 0.25, 0.5, 0.75);
}

TEST(Physics, CoverageMixesWithWhatIsBehind) {
  SceneBuilder scene;
  Json veil = unlit(1, 0, 0);
  veil["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.25;
  veil["alphaMode"] = "BLEND";
  scene.node("Veil", {{"mesh", scene.mesh("Veil", plane_mesh(1, 1), scene.material("Veil", veil))},
                      {"translation", {0, 1, 0}}});
  scene.environment({{"color", {0, 0, 1}}});
  const Rgba alone = seen(scene, Point(0, 3, 0), Point(0, 0, 0));
  expect_near(alone, 0.25, 0, 0.75);
  EXPECT_NEAR(alone.a, 0.25, 1e-6);
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(1, 1), scene.material("Green", unlit(0, 1, 0)))}});
  const Rgba backed = seen(scene, Point(0, 3, 0), Point(0, 0, 0));
  expect_near(backed, 0.25, 0.75, 0);
  EXPECT_NEAR(backed.a, 1, 1e-6);
}

}  // namespace
}  // namespace relook
