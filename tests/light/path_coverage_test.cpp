// Coverage behind a scattering, where a ray stops or passes by chance: what stacks of sheets let through has a closed
// form, 1 - a for each, and whatever lobe looks at them shows it.
#include <gtest/gtest.h>

#include <cmath>

#include "color/physics_scenes.h"
#include "path_albedo.h"
#include "path_studio.h"
#include "scene/coverage_bucket.h"

namespace relook {
namespace {

Vec grey(double x) { return {x, x, x}; }

Json covering(Json material, double coverage) {
  material["alphaMode"] = "BLEND";
  material["doubleSided"] = true;
  material["pbrMetallicRoughness"]["baseColorFactor"][3] = coverage;
  return material;
}
/// Of that radiance on both sides.
Json veil(double radiance, double coverage) { return covering(unlit(radiance, radiance, radiance), coverage); }

/// A floor and sheets above it, so wide that next to nothing of a hemisphere sees past them.
PathStudio stack_studio(const Json& floor, const Json& sheet, int sheets) {
  PathStudio scene;
  scene.node("Floor", {{"mesh", scene.mesh("Floor", plane_mesh(10, 1), scene.material("Floor", floor))}});
  const int mesh = scene.mesh("Sheet", plane_mesh(500, 1), scene.material("Sheet", sheet));
  for (int i = 0; i < sheets; ++i)
    scene.node("Sheet" + std::to_string(i), {{"mesh", mesh}, {"translation", {0, 2 + 0.05 * i, 0}}});
  return scene;
}
/// Of the floor, from below the sheets.
Measured floor_of(PathStudio& scene) { return scene.seen(Point(0.6F, 0.8F, 0), Point(0, 0, 0)); }

double share_left(double coverage, int sheets) { return std::pow(1 - coverage, sheets); }

/// What a metal of roughness 0.05 shows at that angle.
double mirror_share() {
  return ggx_albedo(0.8, 0.05, [](double) { return 1.0; });
}

struct Stack {
  double coverage;
  int sheets;
};
constexpr Stack kStacks[] = {{0, 2},   {0.01, 1}, {0.01, 16}, {0.3, 1}, {0.3, 3},
                             {0.9, 2}, {0.99, 1}, {0.999, 3}, {1, 2}};
std::string name_of(const Stack& stack, const char* what) {
  return std::to_string(stack.sheets) + " sheets of coverage " + std::to_string(stack.coverage) + ", " + what;
}

TEST(CoverageBuckets, are_five_and_lose_neither_way_in_between) {
  using Bucket = CoverageBucket;
  const auto below = [](float x) { return std::nextafter(x, 0.0F); };
  const auto above = [](float x) { return std::nextafter(x, 2.0F); };
  const std::pair<float, Bucket> values[] = {
      {-1, Bucket::none},         {0, Bucket::none},          {1e-7F, Bucket::none},
      {1e-6F, Bucket::little},    {0.01F, Bucket::little},    {below(1.0F / 64), Bucket::little},
      {1.0F / 64, Bucket::half},  {0.5F, Bucket::half},       {63.0F / 64, Bucket::half},
      {above(63.0F / 64), Bucket::most}, {0.999F, Bucket::most}, {1 - 1e-7F, Bucket::all},
      {1, Bucket::all},           {3, Bucket::all}};
  for (const auto& [coverage, bucket] : values) {
    EXPECT_EQ(bucket_of_coverage(coverage), bucket) << coverage;
    const float passing = passing_share(bucket);
    if (bucket == Bucket::none || bucket == Bucket::all) {
      EXPECT_EQ(passing, bucket == Bucket::none ? 1 : 0);
      continue;
    }
    EXPECT_GT(passing, 0);
    EXPECT_LT(passing, 1);
    EXPECT_LT((1 - coverage) / passing, 2) << coverage;
    EXPECT_LT(coverage / (1 - passing), 2) << coverage;
  }
}

TEST(PathCoverage, the_eye_sees_sixteen_sheets_without_noise_and_nothing_behind_the_last) {
  // The seventeenth brings its own light; no ray goes on behind it.
  for (const int sheets : {1, 6, 16, 17}) {
    PathStudio scene = stack_studio(lambert(0), veil(0.25, 0.1), sheets);
    add_white_sky(scene);
    const double through = share_left(0.1, sheets);
    const double expected = 0.25 * (1 - through) + (sheets <= 16 ? through : 0);
    expect_measured(scene.seen(Point(0.6F, 0.8F, 0), Point(0.6F, 4, 0.1F), 4), grey(expected),
                    name_of({0.1, sheets}, "to the eye"), 1e-5);
  }
}

TEST(PathCoverage, a_stack_before_the_sky_lets_through_what_it_does_not_cover) {
  for (const Stack& stack : kStacks) {
    const double through = share_left(stack.coverage, stack.sheets), seen = through + 0.25 * (1 - through);
    for (const bool is_mirror : {false, true}) {
      PathStudio scene = stack_studio(is_mirror ? metal(0.05) : lambert(0.5), veil(0.25, stack.coverage), stack.sheets);
      add_white_sky(scene);
      expect_measured(floor_of(scene), grey((is_mirror ? mirror_share() : 0.5) * seen),
                      name_of(stack, is_mirror ? "by a mirror" : "by a dull floor"));
    }
  }
}

TEST(PathCoverage, a_stack_before_an_area_light_tints_samples_and_rays_alike) {
  // The sheets are black. A mirror meets the window by its rays, a dull floor by samples, rough metal by both.
  for (const Stack& stack : kStacks) {
    const double through = share_left(stack.coverage, stack.sheets);
    const auto studio = [&](const Json& floor, double size) {
      PathStudio scene = stack_studio(floor, covering(lambert(0), stack.coverage), stack.sheets);
      scene.area("Window", {{"type", "rect"}, {"intensity", 10}, {"size", size}},
                 {{"translation", {0, 4, 0}}, {"rotation", shining({0, -1, 0})}});
      return scene;
    };
    PathStudio mirror = studio(metal(0.05), 60);
    expect_measured(floor_of(mirror), grey(10 * mirror_share() * through), name_of(stack, "by a mirror"), 2e-3);
    for (const bool is_metal : {false, true}) {
      const Json floor = is_metal ? metal(0.5) : lambert(0.5);
      PathStudio scene = studio(floor, 3);
      PathStudio bare = stack_studio(floor, covering(lambert(0), 0), 0);
      bare.area("Window", {{"type", "rect"}, {"intensity", 10}, {"size", 3}},
                {{"translation", {0, 4, 0}}, {"rotation", shining({0, -1, 0})}});
      const Measured open = floor_of(bare);
      expect_alike(floor_of(scene), {open.mean * through, open.error * through},
                   name_of(stack, is_metal ? "by rough metal" : "by a dull floor"));
    }
  }
}

TEST(PathCoverage, a_sheet_lit_by_a_lamp_shows_in_a_mirror_by_its_coverage) {
  // The lamp shines past the small mirror onto the lower side: 2 lux at a cosine of 0.2 / sqrt(1.04), of which the
  // sheet scatters 0.8 / pi. Nothing is behind.
  const double lit = 0.8 / kPi * 2 * 0.2 / std::sqrt(1.04);
  for (const double coverage : {0.01, 0.4, 0.99}) {
    PathStudio scene;
    scene.node("Floor", {{"mesh", scene.mesh("Floor", plane_mesh(0.3F, 1), scene.material("Floor", metal(0.05)))}});
    scene.node("Sheet", {{"mesh", scene.mesh("Sheet", plane_mesh(50, 1),
                                             scene.material("Sheet", covering(lambert(0.8), coverage)))},
                         {"translation", {0, 2, 0}}});
    scene.light("Sun", {{"type", "directional"}, {"intensity", 2}}, {{"rotation", shining({1, 0.2, 0})}});
    expect_measured(floor_of(scene), grey(mirror_share() * coverage * lit), "coverage " + std::to_string(coverage));
  }
}

TEST(PathCoverage, leaves_of_texels_cover_by_their_mean) {
  // A checkered sheet, a half of it holes: cells of a metre that change places where x is turned around.
  const auto image = single_level_image(
      16, [](std::uint32_t x, std::uint32_t y) { return Rgba(1, 1, 1, (x / 4 + y / 4) % 2 == 0 ? 1.0F : 0.0F); });
  PathStudio scene;
  scene.node("Floor", {{"mesh", scene.mesh("Floor", plane_mesh(10, 1), scene.material("Floor", lambert(0.5)))}});
  Json leaves = veil(0.25, 1);
  Json& texture = leaves["pbrMetallicRoughness"]["baseColorTexture"];
  texture["index"] = scene.texture("Leaves", scene.image("Leaves", image));
  texture["extensions"]["KHR_texture_transform"]["scale"] = {250, 250};
  scene.node("Sheet", {{"mesh", scene.mesh("Sheet", plane_mesh(500, 1), scene.material("Sheet", leaves))},
                       {"translation", {0, 2, 0}}});
  add_white_sky(scene);
  expect_measured(floor_of(scene), grey(0.5 * (0.5 + 0.5 * 0.25)), "leaves", 2e-3);
}

}  // namespace
}  // namespace relook
