// Closed forms of lights with a size, of emission and of the sky, over planes: each expected value is derived beside
// it, from optics alone. Whatever two techniques estimate together is the same light as either's.
#include <gtest/gtest.h>

#include <cmath>

#include "color/physics_scenes.h"
#include "path_studio.h"

namespace relook {
namespace {

const Json kDown = shining({0, -1, 0});

Json sized(const char* type, double intensity, const char* what, double size) {
  Json light = {{"type", type}, {"intensity", intensity}};
  light["extras"]["relook"][what] = size;
  return light;
}
Json at_height(double height) { return {{"translation", {0, height, 0}}, {"rotation", kDown}}; }
Json rect(double nits, double width, double height) {
  Json light = {{"type", "rect"}, {"intensity", nits}, {"size", height}};
  light["rect"]["aspect"] = width / height;
  return light;
}

/// With a plane y = 0 of a material.
PathStudio plane_studio(const Json& material) {
  PathStudio scene;
  scene.node("Plane", {{"mesh", scene.mesh("Plane", plane_mesh(10, 1), scene.material("Plane", material))}});
  return scene;
}
Measured middle_of(PathStudio& scene, std::uint32_t samples = 64) {
  return scene.seen(Point(2, 1, 0.5F), Point(0, 0, 0), samples);
}

/// Form factor of a rectangle for a surface that faces its middle from `height` (Siegel and Howell, configuration of a
/// parallel rectangle seen from under one corner, four times).
double form_factor(double width, double depth, double height) {
  const double a = width / 2 / height, b = depth / 2 / height, ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  return 4 / (2 * kPi) * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb));
}

TEST(PathPhysics, a_rectangle_lights_by_its_form_factor) {
  for (const double height : {0.05, 1.0, 30.0}) {
    PathStudio scene = plane_studio(lambert(0.5));
    scene.area("Window", rect(10, 3, 1), at_height(height));
    expect_measured(middle_of(scene), grey(0.5 * 10 * form_factor(3, 1, height)),
                    "height " + std::to_string(height));
  }
}

TEST(PathPhysics, a_disk_lights_by_its_form_factor) {
  // r^2 / (r^2 + h^2)
  for (const double height : {0.05, 1.0, 30.0}) {
    PathStudio scene = plane_studio(lambert(0.5));
    scene.area("Disk", {{"type", "disk"}, {"intensity", 10}, {"size", 2}}, at_height(height));
    expect_measured(middle_of(scene), grey(0.5 * 10 / (1 + height * height)), "height " + std::to_string(height));
  }
}

TEST(PathPhysics, areas_shine_to_one_side) {
  PathStudio scene = plane_studio(lambert(0.5));
  scene.area("Window", rect(10, 3, 1), {{"translation", {0, 1, 0}}, {"rotation", shining({0, 1, 0})}});
  scene.area("Disk", {{"type", "disk"}, {"intensity", 10}, {"size", 2}},
             {{"translation", {0, 1, 0}}, {"rotation", shining({0, 1, 0})}});
  expect_measured(middle_of(scene), grey(0), "behind");
}

TEST(PathPhysics, a_sphere_lights_as_the_lamp_in_its_middle) {
  // Outside of a sphere that is seen whole the irradiance is I cos / d^2, whatever the radius.
  for (const double radius : {1e-3, 0.1, 1.5}) {
    PathStudio scene = plane_studio(lambert(0.5));
    scene.light("Bulb", sized("point", 100, "radius", radius), {{"translation", {1, 2, 0}}});
    expect_measured(middle_of(scene), grey(0.5 / kPi * 100 * 2 / std::pow(5, 1.5)), "radius " + std::to_string(radius));
  }
}

TEST(PathPhysics, a_spot_with_a_radius_keeps_its_cone) {
  PathStudio scene = plane_studio(lambert(0.5));
  Json light = sized("spot", 100, "radius", 0.2);
  light["spot"] = {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.5}};
  scene.light("Spot", light, at_height(2));
  expect_measured(middle_of(scene), grey(0.5 / kPi * 100 / 4), "below");
  expect_measured(scene.seen(Point(2, 1, 3), Point(0, 0, 3)), grey(0), "outside of the cone");
}

TEST(PathPhysics, a_disc_in_the_sky_lights_as_the_lamp_in_its_middle) {
  for (const double angle : {1e-3, 0.0093, 0.5, 1.5}) {
    PathStudio scene = plane_studio(lambert(0.5));
    scene.light("Sun", sized("directional", 3, "angle", angle), {{"rotation", shining({0.5, -1, 0.2})}});
    expect_measured(middle_of(scene), grey(0.5 / kPi * 3 / std::sqrt(1.29)), "angle " + std::to_string(angle));
  }
}

TEST(PathPhysics, a_smooth_metal_shows_a_light_s_radiance) {
  // From far inside the picture of a large rectangle nearly all of the lobe falls on it.
  PathStudio scene = plane_studio(metal(0.05));
  scene.area("Window", rect(7, 20, 20), at_height(1));
  expect_measured(scene.seen(Point(0, 2, 0.1F), Point(0, 0, 0)), grey(7), "picture", 2e-3);
}

TEST(PathPhysics, lamps_without_size_are_the_whitted_integrator_s) {
  PathStudio scene = plane_studio(lambert(0.5));
  scene.light("Lamp", {{"type", "point"}, {"intensity", 100}}, {{"translation", {3, 4, 0}}});
  scene.light("Sun", {{"type", "directional"}, {"intensity", 2}}, {{"rotation", kDown}});
  expect_measured(middle_of(scene), grey(0.5 / kPi * (100 * 0.8 / 25 + 2)), "lamps", 1e-4);
}

TEST(PathPhysics, a_mesh_that_shines_lights_by_its_form_factor) {
  for (const double roughness : {0.2, 1.0}) {
    PathStudio scene = plane_studio(lambert(0.5));
    Json glow = metal(roughness);
    glow["emissiveFactor"] = {1, 0.5, 0};
    glow["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 10;
    scene.node("Card", {{"mesh", scene.mesh("Card", card_mesh(1.5F, 0.5F), scene.material("Glow", glow))},
                        {"translation", {0, 1, 0}},
                        {"rotation", shining({0, 1, 0})}});  // +z down
    const double value = 0.5 * 10 * form_factor(3, 1, 1);
    expect_measured(middle_of(scene), Vec(value, value / 2, 0), "card");
  }
}

TEST(PathPhysics, emission_images_light_as_they_show) {
  // Half of the card is black: the light of the other half alone.
  PathStudio scene = plane_studio(lambert(0.5));
  const int image = scene.image("Half", single_level_image(64, [](std::uint32_t x, std::uint32_t) {
                                  return x < 32 ? Rgba(0, 0, 0, 1) : Rgba(1, 1, 1, 1);
                                }));
  Json glow = lambert(0);
  glow["emissiveFactor"] = {1, 1, 1};
  glow["emissiveTexture"] = {{"index", scene.texture("Half", image)}};
  scene.node("Card", {{"mesh", scene.mesh("Card", card_mesh(2, 0.5F), scene.material("Glow", glow))},
                      {"translation", {0, 1, 0}},
                      {"rotation", shining({0, 1, 0})}});
  expect_measured(middle_of(scene, 256), grey(0.5 * form_factor(4, 1, 1) / 2), "half", 5e-3);
}

TEST(PathPhysics, a_thin_filter_tints_its_shadow) {
  // (1 - F) base colour, F at normal incidence.
  for (const bool is_soft : {false, true}) {
    PathStudio scene = plane_studio(lambert(0.5));
    Json filter = glass(1.5, 0);
    filter["doubleSided"] = true;
    filter["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0.5, 0.25, 1};
    scene.node("Filter", {{"mesh", scene.mesh("Filter", plane_mesh(5, 1), scene.material("Filter", filter))},
                          {"translation", {0, 3, 0}}});
    Json light = {{"type", "directional"}, {"intensity", 2}};
    if (is_soft) light = sized("directional", 2, "angle", 0.1);
    scene.light("Sun", light, {{"rotation", kDown}});
    const double value = 0.5 / kPi * 2 * 0.96;
    expect_measured(middle_of(scene), Vec(value, value / 2, value / 4), is_soft ? "soft" : "sharp");
  }
}

TEST(PathPhysics, segments_through_a_slab_lose_what_both_faces_reflect) {
  PathStudio scene = plane_studio(lambert(0.5));
  Json slab = glass(1.5, 1);
  scene.node("Slab", {{"mesh", scene.mesh("Slab", box_mesh(Point(8, 0.2F, 8)), scene.material("Slab", slab))},
                      {"translation", {0, 3, 0}}});
  scene.light("Sun", sized("directional", 2, "angle", 0.02), {{"rotation", kDown}});
  expect_measured(middle_of(scene), grey(0.5 / kPi * 2 * 0.96 * 0.96), "slab");
}

TEST(PathPhysics, a_light_of_a_low_rate_is_as_bright) {
  // Its samples are fewer where a mirror shows the plane that it lights.
  Measured of_rate[2];
  for (const bool is_low : {false, true}) {
    PathStudio scene = plane_studio(lambert(0.5));
    Json mirror = metal(0.3);
    mirror["doubleSided"] = true;
    scene.node("Mirror", {{"mesh", scene.mesh("Mirror", plane_mesh(0.5F, 1), scene.material("Mirror", mirror))},
                          {"translation", {0, 1, 0}}});
    Json area = rect(10, 1, 1), lamp = {{"type", "point"}, {"intensity", 20}};
    if (is_low) area["extras"]["relook"]["rate"] = lamp["extras"]["relook"]["rate"] = 0.25;
    scene.area("Window", area, {{"translation", {2, 1.5, 0}}, {"rotation", kDown}});
    scene.light("Lamp", lamp, {{"translation", {-2, 1, 0}}});
    of_rate[is_low ? 1 : 0] = scene.seen(Point(0.5F, 0.2F, 0.3F), Point(0, 1, 0), 128);
  }
  EXPECT_GT(of_rate[0].mean.x, 0.1);
  expect_alike(of_rate[1], of_rate[0], "rate");
}

TEST(PathPhysics, what_a_light_excludes_gets_nothing_from_it) {
  const Json materials[] = {lambert(0.5), metal(0.1), metal(0.8)};
  for (const Json& material : materials)
    for (const bool is_excluded : {false, true}) {
      PathStudio scene = plane_studio(material);
      Json placement = at_height(1), lamp_placement = {{"translation", {1, 2, 0}}};
      if (is_excluded)
        placement["extras"]["relook"]["excludes"] = lamp_placement["extras"]["relook"]["excludes"] =
            Json::array({"Plane"});
      scene.area("Window", rect(10, 20, 20), placement);
      scene.light("Bulb", sized("point", 100, "radius", 0.3), lamp_placement);
      const Measured seen = middle_of(scene, 16);
      if (is_excluded)
        EXPECT_EQ(seen.mean, Vec(0, 0, 0)) << material;
      else
        EXPECT_GT(seen.mean.x, 0.5) << material;
    }
}

TEST(PathPhysics, the_camera_sees_a_light_only_if_it_is_visible) {
  for (const bool is_visible : {false, true}) {
    PathStudio scene = plane_studio(metal(0.05));
    Json placement = at_height(1);
    if (is_visible) placement["extras"]["relook"]["visible"] = true;
    scene.area("Window", rect(10, 2, 2), placement);
    expect_measured(scene.seen(Point(0.1F, 0.5F, 0), Point(0.1F, 1, 0.01F), 16), grey(is_visible ? 10 : 0), "directly");
    EXPECT_NEAR(scene.seen(Point(0.1F, 0.5F, 0), Point(0.1F, 0, 0.01F), 64).mean.x, 10, 0.1) << "in a mirror";
  }
}

TEST(PathPhysics, lights_block_nothing) {
  PathStudio scene = plane_studio(lambert(0.5));
  for (int i = 0; i < 2; ++i)
    scene.area("Window" + std::to_string(i), rect(10, 2, 2), at_height(1 + i));
  expect_measured(middle_of(scene), grey(0.5 * 10 * (form_factor(2, 2, 1) + form_factor(2, 2, 2))), "both");
}

TEST(PathPhysics, a_sky_of_one_colour_and_a_lamp_add_up) {
  PathStudio scene = plane_studio(lambert(0.5));
  scene.environment({{"color", {0.2, 0.4, 0.8}}, {"intensity", 2}});
  scene.light("Sun", {{"type", "directional"}, {"intensity", 2}}, {{"rotation", kDown}});
  const double lamp = 0.5 / kPi * 2;
  expect_measured(middle_of(scene), Vec(0.2 + lamp, 0.4 + lamp, 0.8 + lamp), "sky and lamp", 1e-4);
}

TEST(PathPhysics, a_picture_of_the_sky_lights_as_its_mean_over_the_cosine) {
  // A lat-long image of 16 x 16 texels, one of them a sun: what the split into sky and suns brings together is the
  // integral of the interpolated image over the upper hemisphere, weighed by the cosine.
  const auto image = single_level_image(16, [](std::uint32_t x, std::uint32_t y) {
    return x == 5 && y == 3 ? Rgba(900, 600, 300, 1) : Rgba(0.5F, 0.25F * static_cast<float>(y % 3), 1, 1);
  });
  Vec expected(0, 0, 0);
  constexpr int kSteps = 1024;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double v = 0.5 * (i + 0.5) / kSteps, u = (j + 0.5) / kSteps;
      const Uv uv(static_cast<float>(u), static_cast<float>(v));
      const Rgba texel = sample(*image, uv, 0, {Wrap::repeat, Wrap::clamp});
      // cos sin dpolar dazimuth / pi
      const double weight = std::cos(kPi * v) * std::sin(kPi * v) * kPi / (double{kSteps} * kSteps);
      expected += Vec(texel.r, texel.g, texel.b) * (0.5 * weight);
    }
  PathStudio scene = plane_studio(lambert(0.5));
  scene.environment({{"color", {1, 1, 1}}});
  scene.image("Sky", image);
  scene.sky_image("Sky");
  expect_measured(middle_of(scene, 256), expected, "image");
}

}  // namespace
}  // namespace relook
