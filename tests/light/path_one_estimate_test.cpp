// What samples of a light and rays that meet it estimate together is one thing: a surface that shines sends out what it
// shows, and light that is found by rays alone is not left out for the sake of samples that do not exist.
#include <gtest/gtest.h>

#include <cmath>

#include "color/physics_scenes.h"
#include "path_albedo.h"
#include "path_reference_surface.h"
#include "path_studio.h"

namespace relook {
namespace {

Json glowing(Json material) {
  material["emissiveFactor"] = {1, 1, 1};
  return material;
}

/// What a floor and a mirror show of a large shining card right above.
struct Shown {
  Measured by_floor, by_mirror;
};
Shown shown(const Json& material) {
  Measured seen[2];
  for (const bool is_mirror : {false, true}) {
    PathStudio scene;
    scene.node("Floor", {{"mesh", scene.mesh("Floor", plane_mesh(5, 1),
                                             scene.material("Floor", is_mirror ? metal(0.05) : lambert(1)))}});
    scene.node("Card", {{"mesh", scene.mesh("Card", card_mesh(50, 50), scene.material("Card", material))},
                        {"translation", {0, 1, 0}},
                        {"rotation", shining({0, 1, 0})}});
    seen[is_mirror ? 1 : 0] = scene.seen(Point(0.1F, 0.9F, 0), Point(0, 0, 0), 64, 2);
  }
  return {seen[0], seen[1]};
}

TEST(PathOneEstimate, a_card_that_shines_fills_the_floor_with_what_a_mirror_shows) {
  const Shown plain = shown(glowing(lambert(0)));
  EXPECT_NEAR(plain.by_mirror.mean.x, 1, 5e-3);
  EXPECT_NEAR(plain.by_floor.mean.x, 1, 5e-3);
}

TEST(PathOneEstimate, of_a_blended_emitter_only_the_covered_part_shines) {
  Json material = glowing(lambert(0));
  material["alphaMode"] = "BLEND";
  material["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 0.25};
  const Shown card = shown(material);
  EXPECT_NEAR(card.by_mirror.mean.x, 0.25, 5e-3);
  EXPECT_NEAR(card.by_floor.mean.x, 0.25, 5e-3);
}

TEST(PathOneEstimate, holes_of_an_emitter_do_not_shine) {
  Json material = glowing(lambert(0));
  material["alphaMode"] = "MASK";
  material["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 0.25};  // below the cutoff: all of it is a hole
  const Shown card = shown(material);
  EXPECT_EQ(card.by_mirror.mean.x, 0);
  EXPECT_EQ(card.by_floor.mean.x, 0);
}

TEST(PathOneEstimate, a_coat_holds_back_emission_from_samples_as_from_rays) {
  // 1 - F of the coat over the cosine-weighted hemisphere: 1 - (0.04 + 0.96 * 2 / 42).
  Json material = glowing(lambert(0));
  material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.2}};
  const Shown card = shown(material);
  EXPECT_NEAR(card.by_mirror.mean.x, 0.96, 5e-3);
  EXPECT_NEAR(card.by_floor.mean.x, 0.96 - 0.96 * 2 / 42, 5e-3);
}

TEST(PathOneEstimate, a_light_inside_of_rough_glass_is_seen_in_its_faces) {
  // The inside of a volume has no samples of lights: its rays alone bring them. A window of radiance 1 fills all but
  // the horizon of a place on the lower face, which then shows the albedo of its microfacets.
  PathStudio scene;
  Json material = glass(1.5, 1);
  material["pbrMetallicRoughness"]["roughnessFactor"] = 0.75;
  scene.node("Box", {{"mesh", scene.mesh("Box", box_mesh(Point(10, 10, 10)), scene.material("Glass", material))}});
  scene.area("Window", {{"type", "rect"}, {"intensity", 1}, {"size", 19}},
             {{"translation", {0, -9, 0}}, {"rotation", shining({0, -1, 0})}});
  const Measured seen = scene.seen(Point(-0.8F, -9.4F, 0), Point(0, -10, 0), 64, 1);
  const double albedo = ggx_albedo(0.6, 0.75, [](double cosine) { return exact_reflectance(cosine, 1 / 1.5); });
  EXPECT_NEAR(seen.mean.x, albedo, 0.06 * albedo);
}

}  // namespace
}  // namespace relook
