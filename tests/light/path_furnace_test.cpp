// Furnaces: in a sky of one colour of radiance 1 a surface shows its albedo, whatever samples it. Expected are the
// directional albedos of tests/oracle/path_albedo.h; nothing gives more than it gets.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "color/physics_scenes.h"
#include "path_albedo.h"
#include "path_reference_surface.h"
#include "path_studio.h"

namespace relook {
namespace {

constexpr std::array kCosines{1.0, 0.5, 0.2};
constexpr std::array kRoughnesses{0.05, 0.2, 0.5, 1.0};

double no_loss(double) { return 1; }
double of_plastic(double cosine) { return schlick_reflectance(0.04, cosine); }

Json dielectric(double albedo, double roughness) {
  Json material = lambert(albedo);
  material["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
  material.erase("extensions");
  return material;
}

/// What a plane under the sky shows at a cosine of its normal with the view.
Measured plane_in_furnace(const Json& material, double nv, std::uint32_t samples = 64) {
  PathStudio scene;
  Json both = material;
  both["doubleSided"] = true;
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Plane", both))}});
  add_white_sky(scene);
  const auto x = static_cast<float>(3 * std::sqrt(1 - nv * nv)), y = static_cast<float>(3 * nv);
  return scene.seen(Point(x, y, 0), Point(0, 0, 0), samples);
}

std::string name_of(const char* what, double nv, double roughness = 1) {
  return std::string(what) + ", cosine " + std::to_string(nv) + ", roughness " + std::to_string(roughness);
}
TEST(PathFurnace, a_diffuse_plane_shows_its_albedo_without_noise) {
  for (const double nv : kCosines) {
    const Measured seen = plane_in_furnace(lambert(0.6), nv);
    expect_measured(seen, grey(0.6), name_of("diffuse", nv), 1e-5);
    EXPECT_LT(seen.error.x, 1e-6);
  }
}

TEST(PathFurnace, a_metal_of_any_roughness_loses_what_its_microfacets_mask) {
  for (const double nv : kCosines)
    for (const double roughness : kRoughnesses) {
      const Measured seen = plane_in_furnace(metal(roughness), nv);
      const std::string name = name_of("metal", nv, roughness);
      expect_measured(seen, grey(ggx_albedo(nv, roughness, no_loss)), name);
      expect_no_gain(seen, name);
    }
}

TEST(PathFurnace, a_metal_at_both_ends_and_inside_of_an_alpha_bucket) {
  // alpha 1/16 begins a bucket, the next float below ends the one before.
  for (const double roughness : {0.24999, 0.25, 0.25001, 0.3, 0.3535, 0.36, 0.4999, 0.5, 0.70710, 0.70711, 0.9})
    expect_measured(plane_in_furnace(metal(roughness), 0.6), grey(ggx_albedo(0.6, roughness, no_loss)),
                    name_of("metal", 0.6, roughness));
}

TEST(PathFurnace, a_white_dielectric_reflects_and_scatters) {
  for (const double nv : kCosines)
    for (const double roughness : kRoughnesses) {
      const Measured seen = plane_in_furnace(dielectric(1, roughness), nv);
      const std::string name = name_of("dielectric", nv, roughness);
      expect_measured(seen, grey(ggx_albedo(nv, roughness, of_plastic) + 1 - of_plastic(nv)), name);
      expect_no_gain(seen, name);
    }
}

TEST(PathFurnace, metallic_between_mixes_both) {
  // Below, between and above the buckets' bounds of 1/64 and 63/64.
  for (const double metallic : {0.01, 0.02, 0.5, 0.98, 0.99}) {
    Json material = dielectric(0.5, 0.5);
    material["pbrMetallicRoughness"]["metallicFactor"] = metallic;
    const auto of_metal = [](double cosine) { return schlick_reflectance(0.5, cosine); };
    const double expected = metallic * ggx_albedo(0.5, 0.5, of_metal) +
                            (1 - metallic) * (ggx_albedo(0.5, 0.5, of_plastic) + 0.5 * (1 - of_plastic(0.5)));
    expect_measured(plane_in_furnace(material, 0.5), grey(expected), "metallic " + std::to_string(metallic));
  }
}

TEST(PathFurnace, a_coat_takes_from_below_what_it_reflects) {
  for (const double nv : kCosines)
    for (const double roughness : kRoughnesses) {
      Json material = lambert(0.5);
      material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 0.75},
                                                           {"clearcoatRoughnessFactor", roughness}};
      const Measured seen = plane_in_furnace(material, nv);
      const double expected = 0.75 * ggx_albedo(nv, roughness, of_plastic) + 0.5 * (1 - 0.75 * of_plastic(nv));
      expect_measured(seen, grey(expected), name_of("coat", nv, roughness));
    }
}

TEST(PathFurnace, a_sheen_takes_from_below_what_it_scatters) {
  for (const double nv : kCosines)
    for (const double roughness : {0.3, 0.6, 1.0}) {
      Json material = lambert(0.5);
      material["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {0.8, 0.8, 0.8}},
                                                       {"sheenRoughnessFactor", roughness}};
      const double expected = 0.8 * cloth_albedo(nv, roughness) + 0.5 * (1 - 0.8 * sheen_albedo(nv, roughness));
      expect_measured(plane_in_furnace(material, nv), grey(expected), name_of("sheen", nv, roughness), 2e-3);
    }
}

TEST(PathFurnace, a_thin_sheet_of_glass_lets_through_what_it_does_not_reflect) {
  for (const double nv : kCosines)
    for (const double roughness : kRoughnesses) {
      Json material = glass(1.5, 0);
      material["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
      const Measured seen = plane_in_furnace(material, nv);
      const std::string name = name_of("thin glass", nv, roughness);
      // Blurred, each microfacet lets through what it does not reflect.
      const double smooth = ggx_albedo(nv, roughness, of_plastic) + 1 - of_plastic(nv);
      expect_measured(seen, grey(roughness < 0.0625 ? smooth : ggx_albedo(nv, roughness, no_loss)), name);
      expect_no_gain(seen, name);
    }
}

TEST(PathFurnace, a_rough_boundary_of_glass_lets_through_what_its_microfacets_do_not_reflect) {
  // A plane is all that there is of the volume: what goes in or out meets the sky.
  for (const double nv : kCosines)
    for (const double roughness : {0.1, 0.3, 0.6, 1.0})
      for (const bool is_inside : {false, true}) {
        Json material = glass(1.5, 1);
        material["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
        material["doubleSided"] = true;
        PathStudio scene;
        scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Plane", material))}});
        add_white_sky(scene);
        const auto x = static_cast<float>(3 * std::sqrt(1 - nv * nv)), y = static_cast<float>(is_inside ? -3 * nv : 3 * nv);
        const Measured seen = scene.seen(Point(x, y, 0), Point(0, 0, 0));
        const double eta = is_inside ? 1 / 1.5 : 1.5;
        const auto reflectance = [&](double cosine) {
          const double f0 = std::pow(0.5 / 2.5, 2), exact = exact_reflectance(cosine, eta);
          return f0 + (1 - f0) * std::clamp((exact - f0) / (1 - f0), 0.0, 1.0);
        };
        const double expected = ggx_albedo(nv, roughness, reflectance) + rough_transmittance(nv, roughness, eta);
        const std::string name = name_of(is_inside ? "from inside" : "from outside", nv, roughness);
        expect_measured(seen, grey(expected), name, 2e-3);
        expect_no_gain(seen, name);
      }
}

TEST(PathFurnace, half_of_a_rough_sheet_scatters) {
  // transmission 1/2: the other half of what is not reflected is diffuse.
  Json material = glass(1.5, 0);
  material["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
  material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.5;
  const auto passed = [](double cosine) { return 1 - of_plastic(cosine); };
  const double expected =
      ggx_albedo(0.5, 0.5, of_plastic) + 0.5 * ggx_albedo(0.5, 0.5, passed) + 0.5 * (1 - of_plastic(0.5));
  expect_measured(plane_in_furnace(material, 0.5), grey(expected), "half a sheet");
}

TEST(PathFurnace, a_power_lobe_beside_a_diffuse_one) {
  for (const double nv : kCosines)
    for (const double shininess : {0.5, 3.0, 20.0, 300.0}) {
      Json material = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}};
      material["extras"]["relook"] = {{"model", "blinn-phong"},
                                      {"diffuse", {0.5, 0.5, 0.5}},
                                      {"specular", {0.3, 0.3, 0.3}},
                                      {"ambient", {0, 0, 0}},
                                      {"shininess", shininess}};
      expect_measured(plane_in_furnace(material, nv), grey(0.5 + 0.3 * power_albedo(nv, shininess)),
                      name_of("shininess", nv, shininess), 2e-3);
    }
}

TEST(PathFurnace, coverage_mixes_a_surface_with_what_is_behind) {
  Json material = lambert(0.5);
  material["alphaMode"] = "BLEND";
  material["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.5, 0.5, 0.25};
  expect_measured(plane_in_furnace(material, 0.7), grey(0.25 * 0.5 + 0.75), "coverage 1/4", 1e-5);
}

TEST(PathFurnace, a_ball_of_glass_is_next_to_invisible) {
  // What a smooth ball reflects outside comes in from all sides alike; what is lost stays behind the cut-off of 1/1000
  // and what microfacets of roughness 0.05 mask.
  PathStudio scene;
  scene.node("Ball", {{"mesh", scene.mesh("Ball", sphere_mesh(1, 96, 48), scene.material("Glass", glass(1.5, 1)))}});
  add_white_sky(scene);
  scene.look_at(Point(0, 0, 6), Point(0, 0, 0), 14, 16, 16);
  const Measured seen = measured(colors_of(scene.frame(64, 12)));
  expect_no_gain(seen, "ball of glass");
  EXPECT_GT(seen.mean.x, 0.95);
}

TEST(PathFurnace, no_ball_of_any_material_shines) {
  Json coated = dielectric(1, 0.6), cloth = dielectric(1, 0.8), brushed = metal(0.3);
  coated["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.1}};
  cloth["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 0.5}};
  brushed["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", 0.7}};
  Json rough_glass = glass(1.5, 1);
  rough_glass["pbrMetallicRoughness"]["roughnessFactor"] = 0.6;
  const std::pair<const char*, Json> materials[] = {
      {"coated", coated}, {"cloth", cloth}, {"brushed", brushed}, {"rough glass", rough_glass}};
  for (const auto& [name, material] : materials) {
    PathStudio scene;
    scene.node("Ball", {{"mesh", scene.mesh("Ball", sphere_mesh(1, 48, 24), scene.material("Ball", material))}});
    add_white_sky(scene);
    scene.look_at(Point(0, 0, 6), Point(0, 0, 0), 16, 16, 16);
    expect_no_gain(measured(colors_of(scene.frame(64))), name);
  }
}

}  // namespace
}  // namespace relook
