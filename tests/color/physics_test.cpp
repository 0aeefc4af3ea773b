// Closed forms: each expected value is derived beside it, from optics alone.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "test_scenes.h"

namespace relook {
namespace {

constexpr double kPi = std::numbers::pi;

/// What the ray from `eye` to `target` brings: the middle of a picture of one pixel.
Rgba seen(SceneBuilder& scene, Point eye, Point target, std::uint32_t max_depth = 6) {
  scene.look_at(eye, target, 1, 1, 1);
  return rendered(scene.state().scene(), {1, max_depth}).pixels.at(0);
}

/// No highlight: specular 0 leaves base / pi.
Json lambert(double albedo) {
  Json material = {{"pbrMetallicRoughness",
                    {{"baseColorFactor", {albedo, albedo, albedo, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}};
  material["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
  return material;
}

Json metal(double roughness) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 1}, {"roughnessFactor", roughness}}}};
}

/// A smooth dielectric interface of transmission 1; a volume when `thickness` > 0.
Json glass(double ior, double thickness) {
  Json material = {
      {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}}}};
  material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  material["extensions"]["KHR_materials_ior"]["ior"] = ior;
  if (thickness > 0) material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = thickness;
  return material;
}

Json unlit(double r, double g, double b) {
  Json material = {{"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}}}};
  material["extensions"]["KHR_materials_unlit"] = Json::object();
  return material;
}

/// A node rotation that turns -z, the way a light shines, into `way`.
Json shining(Imath::V3d way) {
  way.normalize();
  const Imath::V3d from(0, 0, -1), axis = from.cross(way);
  const double w = 1 + from.dot(way);
  if (w < 1e-9) return {0, 1, 0, 0};
  const double length = std::sqrt(axis.length2() + w * w);
  return {axis.x / length, axis.y / length, axis.z / length, w / length};
}

void expect_near(const Rgba& pixel, double r, double g, double b, double relative = 1e-4) {
  EXPECT_NEAR(pixel.r, r, relative * r + 1e-6);
  EXPECT_NEAR(pixel.g, g, relative * g + 1e-6);
  EXPECT_NEAR(pixel.b, b, relative * b + 1e-6);
}

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
    scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1)))}});
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
    scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1)))}});
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
    scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1)))}});
    scene.light("Lamp", {{"type", "point"}, {"intensity", 10}, {"range", range}}, {{"translation", {0, 2, 0}}});
    const double radiance = 10 / kPi / 4 * std::max(0.0, 1 - std::pow(2 / range, 4));
    expect_near(seen(scene, Point(0, 3, 1), Point(0, 0, 0)), radiance, radiance, radiance);
  }
}

/// A textured box that glows by itself, over (or, mirrored, under) the plane y = 0.
void add_box(SceneBuilder& scene, bool mirrored) {
  Json glow = lambert(0);
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

/// A Lambert plane under a vertical sun of pi lux: radiance 1 where nothing stands between.
SceneBuilder sunlit_plane() {
  SceneBuilder scene;
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1)))}});
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
  Json dielectric = lambert(1), coated = lambert(1), velvet = lambert(1), rough_metal = metal(0.5), rougher = metal(1), brushed = metal(0.5);
  dielectric["extensions"].erase("KHR_materials_specular");
  dielectric["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
  coated["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.5}};
  velvet["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 0.5}};
  brushed["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 0.5}};
  for (const double view : {5.0, 45.0}) {
    SCOPED_TRACE(view);
    EXPECT_NEAR(furnace(lambert(1), view), 1, 0.005);  // all of it comes back: the integral of cos / pi
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
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Dull", lambert(1)))}});
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
