// Spots of any width: KHR_lights_punctual's cone, where cosines of floats have no digits left. Expected values are
// derived in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Black but for what a spot at (0, 0, distance) throws at it, in sight of the middle `width` metres.
SceneState lit_wall(double distance, double inner, double outer, double width, std::uint32_t pixels) {
  SceneBuilder scene;
  Json white = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}};
  white["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
  const auto half = static_cast<float>(distance);
  scene.node("Wall", {{"mesh", scene.mesh("Wall", card_mesh(half, half), scene.material("White", white))}});
  scene.light("Spot",
              {{"type", "spot"}, {"intensity", 10}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}},
              {{"translation", {0, 0, distance}}});
  scene.look_orthographic(Point(0, 0, static_cast<float>(distance) / 2), Point(0, 0, 0),
                          static_cast<float>(width / 2 / pixels), pixels, 1);
  return scene.state();
}

/// Radiance of the wall at `x` metres from the axis.
double expected(double distance, double inner, double outer, double x) {
  const double angle = std::atan2(x, distance), d = std::hypot(x, distance);
  const double t = std::clamp((std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0, 1.0);
  return 10 / std::numbers::pi * t * t * std::cos(angle) / (d * d);
}

TEST(NarrowSpots, fade_as_in_double_arithmetic) {
  constexpr std::uint32_t kPixels = 101;
  for (const double degrees : {30.0, 5.0, 1.0, 0.1})
    for (const double share : {0.0, 0.5, 0.9})
      for (const double distance : {1.0, 100.0}) {
        SCOPED_TRACE(std::to_string(degrees) + " degrees, inner " + std::to_string(share) + ", " +
                     std::to_string(distance) + " m");
        const double outer = degrees * kRadians, inner = share * outer, width = 2.4 * distance * std::tan(outer);
        const Frame frame = rendered(lit_wall(distance, inner, outer, width, kPixels).scene(), {1, 1});
        const double most = expected(distance, inner, outer, 0);
        for (std::uint32_t i = 0; i < kPixels; ++i) {
          const double x = ((i + 0.5) / kPixels - 0.5) * width;
          EXPECT_NEAR(frame.pixels[i].r, expected(distance, inner, outer, x), 2e-3 * most) << "pixel " << i;
        }
      }
}

TEST(NarrowSpots, one_cone_is_a_hard_edge) {
  constexpr std::uint32_t kPixels = 100;
  for (const double degrees : {45.0, 1.0, 0.1}) {
    const double outer = degrees * kRadians, width = 4 * std::tan(outer);
    SceneState state = lit_wall(1, 0, outer, width, kPixels);
    Image image = preprocessed(state.scene(), {1, 1});
    Replayer replayer(std::move(state), std::move(image));
    replayer.step(replace_edit("/lights/Spot/spot/innerConeAngle", outer), "", ".");
    const Frame& frame = replayer.image().frame;
    for (std::uint32_t i = 0; i < kPixels; ++i) {
      const double x = ((i + 0.5) / kPixels - 0.5) * width;
      const bool is_lit = std::fabs(x) < std::tan(outer);
      const double lit = 10 / std::numbers::pi * std::pow(std::cos(std::atan(x)), 3);
      EXPECT_NEAR(frame.pixels[i].r, is_lit ? lit : 0, 1e-4 * lit) << degrees << " degrees, pixel " << i;
    }
    EXPECT_EQ(different_pixels(frame, rendered(replayer.state().scene(), {1, 1})).size(), 0U);
  }
}

}  // namespace
}  // namespace relook
