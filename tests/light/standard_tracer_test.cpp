// The standard path tracer that the bench measures errors against has the same mean as the program, whichever choices
// it makes.
#include "standard_tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "hammersley.h"
#include "path_studio.h"
#include "pi.h"

namespace relook {
namespace {

constexpr std::array kRules{SamplingRules{}, SamplingRules{.apart = true},
                            SamplingRules{.plain_shares = true, .buckets = true},
                            SamplingRules{.apart = true, .plain_shares = true, .buckets = true, .split = true}};

Rgba sky_with_sun(std::uint32_t x, std::uint32_t y) {
  return x == 2 && y == 1 ? Rgba(40, 30, 20, 1) : Rgba(0.2F, 0.3F, y < 4 ? 0.8F : 0.1F, 1);
}

/// By every rule the differences of pixels have a mean of zero. Each is taken relative to what its pixel has in a
/// picture of other samples, so that a few highlights do not hide all else.
void expect_mean_of_program(const SceneState& state, const std::string& what) {
  constexpr std::uint64_t kOtherSeed = 100;
  ViewOptions view;
  view.samples = 256;
  view.diffuse_depth = 2;
  view.integrator = Integrator::path;
  const std::vector<Vec> program = colors_of(rendered(state.scene(), view));
  const std::vector<Vec> guide = StandardTracer(state.scene(), view).pixels(view.samples, kOtherSeed);
  const Vec floor = measured(guide).mean * 0.1;
  for (std::size_t i = 0; i < kRules.size(); ++i) {
    const std::vector<Vec> standard = StandardTracer(state.scene(), view, kRules[i]).pixels(view.samples, i);
    ASSERT_EQ(program.size(), standard.size());
    std::vector<Vec> ratios;
    for (std::size_t p = 0; p < program.size(); ++p)
      ratios.push_back(Vec(1, 1, 1) + (program[p] - standard[p]) / (guide[p] + floor));
    expect_measured(measured(ratios), Vec(1, 1, 1), what + ", rules " + std::to_string(i));
  }
}

TEST(StandardTracer, means_under_a_sky_with_a_sun_are_the_programs) {
  expect_mean_of_program(still_life_scene(single_level_image(8, sky_with_sun), 0.3F, 24, 16), "sky");
}

TEST(StandardTracer, means_under_a_rectangle_are_the_programs) {
  expect_mean_of_program(still_life_scene(nullptr, 1, 24, 16), "rectangle");
}

TEST(StandardTracer, directions_to_the_environment_have_the_density_that_it_says) {
  const LuminanceMap map(8, 5, [](std::uint32_t x, std::uint32_t y) { return x == 3 && y == 2 ? 20.0 : 1.0 + x; });
  constexpr std::uint32_t kRows = 500, kPoints = 1U << 16U;
  double integral = 0;
  for (std::uint32_t i = 0; i < kRows; ++i)
    for (std::uint32_t j = 0; j < 2 * kRows; ++j) {
      const double tilt = kPi * (i + 0.5) / kRows, turn = kPi * (j + 0.5) / kRows;
      const Vec way(std::sin(tilt) * std::sin(turn), std::cos(tilt), -std::sin(tilt) * std::cos(turn));
      integral += map.density(way) * std::sin(tilt) * std::pow(kPi / kRows, 2);
    }
  EXPECT_NEAR(integral, 1, 1e-4);
  // Draws weighted by their density are even over the sphere.
  double sphere = 0, upper = 0;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const Uv u = hammersley_point(i, kPoints);
    const Vec way = map.draw(u.x, u.y);
    EXPECT_NEAR(way.length(), 1, 1e-12);
    sphere += 1 / map.density(way) / kPoints;
    upper += way.y > 0 && way.x > 0 ? 1 / map.density(way) / kPoints : 0;
  }
  EXPECT_NEAR(sphere, 4 * kPi, 0.02);
  EXPECT_NEAR(upper, kPi, 0.02);
}

}  // namespace
}  // namespace relook
