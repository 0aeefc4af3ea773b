// Closed forms of lights, mirrors and glass: each expected value is derived beside it, from optics alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics_scenes.h"

namespace relook {
namespace {

TEST(Physics, PointLightOverALambertPlaneFallsWithTheSquareOfTheDistance) {
  // Radiance = albedo / pi * intensity * cos / d^2; with the light at (3, 4, 0) k: d = 5 k, cos = 4/5.
  for (const double k : {0.5, 1.0, 2.0, 4.0}) {
    SceneBuilder scene;
    scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(0.5)))}});
    scene.light("Lamp", {{"type", "point"}, {"intensity", 100}}, {{"translation", {3 * k, 4 * k, 0}}});
    const double radiance = 0.5 / kPi * 100 * 0.8 / (25 * k * k);
    expect_near(seen(scene, Point(0, 3, 1), Point(0, 0, 0)), radiance, radiance, radiance);
  }
}

TEST(Physics, DirectionalLightOverALambertPlaneFollowsTheCosine) {
  for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
    SceneBuilder scene;
    scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1.0)))}});
    const double angle = degrees * kPi / 180;
    scene.light("Sun", {{"type", "directional"}, {"intensity", 2}},
                {{"rotation", shining({std::sin(angle), -std::cos(angle), 0})}});
    const double radiance = 2 * std::cos(angle) / kPi;
    expect_near(seen(scene, Point(0, 3, 1), Point(0, 0, 0)), radiance, radiance, radiance);
  }
}

TEST(Physics, SpotConeFadesBetweenInnerAndOuterAngle) {
  // KHR_lights_punctual: t = (cos a - cos outer) / (cos inner - cos outer), squared. The plane lies 2 below the light,
  // so the point at tan(a) * 2 has d = 2 / cos a and the cosine of incidence cos a.
  const double inner = 0.2, outer = 0.6;
  for (const double a : {0.0, 0.15, 0.3, 0.45, 0.59, 0.7}) {
    SceneBuilder scene;
    scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1.0)))}});
    scene.light("Spot",
                {{"type", "spot"}, {"intensity", 10}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}},
                {{"translation", {0, 2, 0}}, {"rotation", shining({0, -1, 0})}});
    const double t = std::clamp((std::cos(a) - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0, 1.0);
    const double radiance = 10 / kPi * t * t * std::pow(std::cos(a), 3) / 4;
    const Point target(static_cast<float>(2 * std::tan(a)), 0, 0);
    expect_near(seen(scene, target + Point(0, 3, 1), target), radiance, radiance, radiance, 5e-4);
  }
}

TEST(Physics, RangeWindowEndsTheLightSmoothly) {
  // window = (1 - (d / range)^4)+ on top of the inverse square, d = 2.
  for (const double range : {1.5, 2.0, 2.5, 4.0, 100.0}) {
    SceneBuilder scene;
    scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1.0)))}});
    scene.light("Lamp", {{"type", "point"}, {"intensity", 10}, {"range", range}}, {{"translation", {0, 2, 0}}});
    const double radiance = 10 / kPi / 4 * std::max(0.0, 1 - std::pow(2 / range, 4));
    expect_near(seen(scene, Point(0, 3, 1), Point(0, 0, 0)), radiance, radiance, radiance);
  }
}

/// A textured box that glows by itself, over (or, mirrored, under) the plane y = 0.
void add_box(SceneBuilder& scene, bool mirrored) {
  Json glow = lambert(0.0);
  const int image = scene.image("Picture", single_level_image(8, [](std::uint32_t x, std::uint32_t y) {
                                  return Rgba(static_cast<float>(x) / 8, static_cast<float>(y) / 8, 0.5F, 1);
                                }));
  glow["emissiveFactor"] = {1, 1, 1};
  glow["emissiveTexture"] = {{"index", scene.texture("Picture", image)}};
  const int box = scene.mesh("Box", box_mesh(Point(0.5F, 0.7F, 0.4F)), scene.material("Glow", glow));
  const double side = mirrored ? -1 : 1;
  scene.node("Box", {{"mesh", box}, {"translation", {0.2, side, -1}}, {"scale", {1, side, 1}}});
}

TEST(Physics, PlaneMirrorShowsTheMirrorImage) {
  // A perfect mirror (metal, F = 1) seen from above shows what would be seen if it were not there and the box stood
  // upside down below it.
  SceneBuilder mirror, virtual_box;
  mirror.node("Mirror", {{"mesh", mirror.mesh("Mirror", plane_mesh(20, 1), mirror.material("Metal", metal(0)))}});
  add_box(mirror, false);
  add_box(virtual_box, true);
  // Narrow, aimed at the image in the mirror: the box itself is out of the picture.
  for (SceneBuilder* scene : {&mirror, &virtual_box})
    scene->look_at(Point(0, 2, 6), Point(0.2F, -1.2F, -1), 12, 40, 40);
  const Frame reflected = rendered(mirror.state().scene(), {1, 2});
  const Frame direct = rendered(virtual_box.state().scene(), {1, 1});
  std::size_t differing = 0, lit = 0;
  for (std::size_t i = 0; i < direct.pixels.size(); ++i) {
    const Rgba &a = reflected.pixels[i], &b = direct.pixels[i];
    lit += b.b > 0 ? 1 : 0;
    differing += std::fabs(a.r - b.r) + std::fabs(a.g - b.g) + std::fabs(a.b - b.b) > 1e-3F ? 1 : 0;
  }
  EXPECT_GT(lit, 400U);
  EXPECT_LT(lit, 1500U);     // the outline is in the picture
  EXPECT_LE(differing, 4U);  // pixels whose centre is on the outline
}

/// An unlit plane y = `height` whose red is (x + 10) / 20, its green 1: red / green tells where it was hit.
void add_ruler(SceneBuilder& scene, double height) {
  Mesh plane = plane_mesh(10, 1);
  for (const Point& p : plane.positions) plane.colors.emplace_back((p.x + 10) / 20, 1.0F, 0.0F, 1.0F);
  scene.node("Ruler", {{"mesh", scene.mesh("Ruler", plane, scene.material("Ruler", unlit(1, 1, 1)))},
                       {"translation", {0, height, 0}}});
}
double position_on_ruler(const Rgba& pixel) { return pixel.r / double{pixel.g} * 20 - 10; }

TEST(Physics, SlabShiftsARayBySnellsLaw) {
  // A slab from y = 0 to y = -1, the ruler at y = -2, a ray that meets the slab at the origin under angle a: inside it
  // runs under b, sin b = sin a / n, and leaves under a again.
  for (const double n : {1.2, 1.5, 2.0}) {
    for (const double a : {0.1, 0.5, 0.9, 1.2}) {
      SceneBuilder scene;
      const int slab = scene.mesh("Slab", box_mesh(Point(8, 0.5F, 8)), scene.material("Glass", glass(n, 1)));
      scene.node("Slab", {{"mesh", slab}, {"translation", {0, -0.5, 0}}});
      add_ruler(scene, -2);
      const double b = std::asin(std::sin(a) / n);
      const Point eye(static_cast<float>(-std::sin(a)), static_cast<float>(std::cos(a)), 0);
      const Rgba pixel = seen(scene, eye, Point(0, 0, 0), 3);
      EXPECT_NEAR(position_on_ruler(pixel), std::tan(b) + std::tan(a), 2e-4) << "n " << n << " a " << a;
    }
  }
}

TEST(Physics, ThinWallLetsARayStraightOn) {
  SceneBuilder scene;
  scene.node("Pane", {{"mesh", scene.mesh("Pane", plane_mesh(8, 1), scene.material("Glass", glass(1.5, 0)))}});
  add_ruler(scene, -2);
  EXPECT_NEAR(position_on_ruler(seen(scene, Point(-1, 1, 0), Point(0, 0, 0))), 2, 2e-4);
}

TEST(Physics, ThinWallReflectsBySchlicksFresnel) {
  // Normal incidence on a thin pane of ior 1.5 before nothing: 4 % of the environment by reflection, 96 % through it.
  SceneBuilder scene;
  scene.node("Pane", {{"mesh", scene.mesh("Pane", plane_mesh(8, 1), scene.material("Glass", glass(1.5, 0)))}});
  scene.node("Below", {{"mesh", scene.mesh("Below", plane_mesh(9, 1), scene.material("Black", unlit(0, 0, 0)))},
                       {"translation", {0, -1, 0}}});
  scene.environment({{"color", {1, 1, 1}}});
  const Rgba pixel = seen(scene, Point(0, 1, 0), Point(0, 0, 0));
  expect_near(pixel, 0.04, 0.04, 0.04, 1e-3);
}

TEST(Physics, NormalIncidenceReflectsByTheIndexAlone) {
  // F0 = ((n - 1) / (n + 1))^2 of what the mirror direction shows; the base is black, so there is nothing else.
  for (const double n : {1.1, 1.5, 2.0, 3.0}) {
    SceneBuilder scene;
    Json smooth = {
        {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}}}};
    smooth["extensions"]["KHR_materials_ior"]["ior"] = n;
    scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(8, 1), scene.material("Smooth", smooth))}});
    scene.environment({{"color", {1, 0.5, 0.25}}});
    const double f0 = std::pow((n - 1) / (n + 1), 2);
    expect_near(seen(scene, Point(0, 1, 0), Point(0, 0, 0)), f0, f0 * 0.5, f0 * 0.25);
  }
}

/// A prism over the triangle (0,0) (1,0) (0,1) in x and y, 4 long in z: its hypotenuse faces (1, 1, 0).
Mesh prism_mesh() {
  Mesh mesh;
  for (const float z : {-2.0F, 2.0F})
    for (const Point& p : {Point(0, 0, z), Point(1, 0, z), Point(0, 1, z)}) mesh.positions.push_back(p);
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

Rgba seen_through_prism(double ior) {
  SceneBuilder scene;
  scene.node("Prism", {{"mesh", scene.mesh("Prism", prism_mesh(), scene.material("Glass", glass(ior, 1)))}});
  const int wall = scene.mesh("Below", plane_mesh(3, 1), scene.material("Below", unlit(1, 0.5, 0.25)));
  scene.node("Below", {{"mesh", wall}, {"translation", {0, -1, 0}}});
  return seen(scene, Point(-2, 0.4F, 0), Point(0, 0.4F, 0), 4);
}

TEST(Physics, PrismTurnsARayByTotalInternalReflection) {
  // The ray along +x enters the prism at right angles (1 - F0 passes) and meets the hypotenuse under 45 degrees, beyond
  // the critical angle asin(1 / 1.5) = 41.8 degrees: all of it is turned down and leaves at right angles (1 - F0).
  // Four generations end just there, before any second-order reflection.
  const double passes = std::pow(1 - 0.04, 2);
  expect_near(seen_through_prism(1.5), passes, passes * 0.5, passes * 0.25);
}

TEST(Physics, BelowTheCriticalAngleThePrismReflectsByFresnel) {
  // n = 1.3: the critical angle is 50.3 degrees, so 45 degrees pass; unpolarised reflectance of the inner side:
  const double n = 1.3, sine = n * std::sin(kPi / 4), beyond = std::sqrt(1 - sine * sine), c = std::cos(kPi / 4);
  const double s = (n * c - beyond) / (n * c + beyond), p = (n * beyond - c) / (n * beyond + c);
  const double reflected = (s * s + p * p) / 2, f0 = std::pow(0.3 / 2.3, 2);
  const double share = (1 - f0) * (1 - f0) * reflected;
  expect_near(seen_through_prism(n), share, share * 0.5, share * 0.25, 1e-3);
}

TEST(Physics, BeerAttenuatesWithTheLengthOfTheWayInside) {
  // Straight down through a slab of thickness h: (1 - F0)^2 c^(h / distance) of the unlit white below. Three
  // generations end before any internal reflection comes back.
  for (const double h : {0.25, 1.0, 2.0}) {
    SceneBuilder scene;
    Json tinted = glass(1.5, 1);
    tinted["extensions"]["KHR_materials_volume"]["attenuationColor"] = {0.25, 0.5, 1};
    tinted["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 0.5;
    const Point half(8, static_cast<float>(h / 2), 8);
    scene.node("Slab", {{"mesh", scene.mesh("Slab", box_mesh(half), scene.material("Glass", tinted))}});
    scene.node("Below", {{"mesh", scene.mesh("Below", plane_mesh(9, 1), scene.material("White", unlit(1, 1, 1)))},
                         {"translation", {0, -3, 0}}});
    const double passes = 0.96 * 0.96;
    expect_near(seen(scene, Point(0.3F, 5, 0.2F), Point(0.3F, 0, 0.2F), 3), passes * std::pow(0.25, h / 0.5),
                passes * std::pow(0.5, h / 0.5), passes, 5e-4);
  }
}

}  // namespace
}  // namespace relook
