// Properties of colours that hold to the bit, or to the accuracy that portable_math.h promises.
#include <gtest/gtest.h>

#include <cmath>

#include "base/portable_math.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {
namespace {

TEST(PortableMath, AgreesWithTheStandardLibrary) {
  for (int i = -2000; i <= 2000; ++i) {
    const float x = static_cast<float>(i) * 0.0371F;
    EXPECT_NEAR(portable_exp2(x), std::exp2(double{x}), 1e-6 * std::exp2(double{x}));
    EXPECT_NEAR(portable_sin_turns(x * 0.1F), std::sin(2 * 3.14159265358979 * double{x * 0.1F}), 2e-6);
    EXPECT_NEAR(portable_cos_turns(x * 0.1F), std::cos(2 * 3.14159265358979 * double{x * 0.1F}), 2e-6);
    EXPECT_NEAR(portable_asin_turns(x / 75), std::asin(double{x / 75}) / (2 * 3.14159265358979), 1e-5);
    const float positive = std::exp(x * 0.5F);
    EXPECT_NEAR(portable_log2(positive), std::log2(double{positive}), 1e-6 * (1 + std::fabs(std::log2(positive))));
    for (int j = -20; j <= 20; ++j) {
      const float y = static_cast<float>(j) * 0.7F;
      EXPECT_NEAR(portable_atan2_turns(y, x), std::atan2(double{y}, double{x}) / (2 * 3.14159265358979), 1e-6);
    }
  }
}

TEST(PortableMath, DoublesAgreeWithTheStandardLibrary) {
  for (int i = -2000; i <= 2000; ++i) {
    const double x = i * 0.0371;
    EXPECT_NEAR(portable_sin_cos(x).sin, std::sin(x), 1e-15);
    EXPECT_NEAR(portable_sin_cos(x).cos, std::cos(x), 1e-15);
    const double small = std::exp(x);  // 5e-33 to 2e32
    EXPECT_NEAR(portable_atan2(small, 1), std::atan(small), 4e-16 * std::atan(small));
    const double below_one = small / (1 + small);
    EXPECT_NEAR(portable_sin_cos(below_one).sin, std::sin(below_one), 4e-16 * below_one);
    for (int j = -20; j <= 20; ++j) EXPECT_NEAR(portable_atan2(j * 0.7, x), std::atan2(j * 0.7, x), 1e-15);
  }
}

TEST(PortableMath, EdgesOfTheDomain) {
  EXPECT_EQ(portable_atan2(0, 0), 0);
  EXPECT_EQ(portable_sin_cos(0).sin, 0);
  EXPECT_EQ(portable_sin_cos(0).cos, 1);
  EXPECT_EQ(portable_exp2(-1000), 0);
  EXPECT_TRUE(std::isfinite(portable_exp2(1000)));
  EXPECT_EQ(portable_log2(0), -127);
  EXPECT_EQ(portable_atan2_turns(0, 0), 0);
  EXPECT_EQ(portable_cos_turns(0), portable_cos_turns(7));
  EXPECT_EQ(portable_cos_turns(0.25F), 0);
  EXPECT_EQ(portable_floor(-0.5F), -1);
  EXPECT_EQ(portable_floor(2), 2);
}

/// A scene lit by its lamps alone.
SceneState lamps_only(TestScene which, double factor) {
  SceneState state = test_scene(which, 40, 30);
  Json edit = Json::array();
  const auto set = [&](const std::string& pointer, Json value) {
    edit.push_back({{"op", "replace"}, {"path", pointer}, {"value", std::move(value)}});
  };
  set("/scene/extras/relook/ambient", {0, 0, 0});
  set("/scene/extras/relook/environment/color", {0, 0, 0});
  for (const auto& [name, light] : state.document().look.at("lights").items())
    set("/lights/" + name + "/intensity", light.at("intensity").get<double>() * factor);
  for (const auto& [name, material] : state.document().look.at("materials").items())
    set("/materials/" + name + "/emissiveFactor", {0, 0, 0});
  apply_edit(state, edit_of(edit), "lamps", ".");
  return state;
}

TEST(Color, TwiceTheLightIsTwiceTheRadianceToTheBit) {
  // Scaling by two is exact in binary floating point, and every lamp term is a product and a sum of such products.
  for (const TestScene which : {TestScene::spheres, TestScene::cards}) {
    const Frame once = rendered(lamps_only(which, 1).scene(), {1, 6});
    const Frame twice = rendered(lamps_only(which, 2).scene(), {1, 6});
    std::size_t lit = 0;
    for (std::size_t i = 0; i < once.pixels.size(); ++i) {
      const Rgba &a = once.pixels[i], &b = twice.pixels[i];
      ASSERT_EQ(Rgba(a.r * 2, a.g * 2, a.b * 2, a.a), b) << "pixel " << i;
      lit += a.r > 0 ? 1 : 0;
    }
    EXPECT_GT(lit, once.pixels.size() / 4);
  }
}

TEST(Color, NoLightNoColor) {
  for (const TestScene which : {TestScene::spheres, TestScene::cards, TestScene::study})
    for (const Rgba& pixel : rendered(lamps_only(which, 0).scene(), {1, 6}).pixels)
      ASSERT_EQ(Rgba(pixel.r, pixel.g, pixel.b, 0), Rgba(0, 0, 0, 0));
}

TEST(Color, EveryPixelIsFiniteAndNotNegative) {
  for (const TestScene which : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    const SceneState state = test_scene(which, 64, 48);
    for (const Rgba& pixel : rendered(state.scene(), {4, 8}).pixels) {
      for (int channel = 0; channel < 4; ++channel) ASSERT_TRUE(std::isfinite(pixel[channel]) && pixel[channel] >= 0);
      ASSERT_LE(pixel.a, 1.0F);
    }
  }
}

TEST(Color, RenderingTwiceGivesTheSameBits) {
  for (const TestScene which : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    const SceneState state = test_scene(which, 80, 60);
    EXPECT_TRUE(different_pixels(rendered(state.scene(), {4, 6}), rendered(state.scene(), {4, 6})).empty());
  }
}

/// The picture as it would be if textures were swapped by hand: a transform by whole repeats changes nothing.
TEST(Color, TextureTransformRepeatsAndShifts) {
  const auto shifted = [](double u, double v) {
    SceneState state = spheres_scene(40, 30);
    const Edit edit = replace_edit(
        "/materials/Ground/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset", {u, v});
    apply_edit(state, edit, "shift", ".");
    return rendered(state.scene(), {1, 1});
  };
  const Frame still = shifted(0, 0), moved = shifted(0.125, 0), whole = shifted(1, 2);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < still.pixels.size(); ++i) {
    EXPECT_NEAR(still.pixels[i].r, whole.pixels[i].r, 2e-4F);
    changed += std::fabs(still.pixels[i].r - moved.pixels[i].r) > 1e-3F ? 1 : 0;
  }
  EXPECT_GT(changed, still.pixels.size() / 10);
}

}  // namespace
}  // namespace relook
