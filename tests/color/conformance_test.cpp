// Khronos's conformance models as their READMEs say that they look: values at chosen pixels. They lie beside the
// project, in ../shared/assets; without that folder the tests skip and say so.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "scene/gltf/import.h"
#include "test_scenes.h"

namespace relook {
namespace {

const std::filesystem::path kAssets = std::filesystem::path(RELOOK_SOURCE_DIR) / ".." / "shared" / "assets";

struct Pixel {
  int x, y;
};

class Conformance : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kAssets))
      GTEST_SKIP() << "no ../shared/assets beside the project: Khronos's conformance models are NOT tested";
  }
  void render(const char* file, const char* camera, std::uint32_t width, std::uint32_t height) {
    LookDocument document = make_look_document(import_gltf(kAssets / file));
    const Camera chosen = choose_camera(document, camera, width, height);
    (void)add_auto_lights(document, chosen);
    const SceneState state(std::move(document), chosen, std::make_shared<PyramidStore>());
    pixels_ = rendered(state.scene(), {1, 6}).pixels;
    width_ = static_cast<int>(width);
  }
  [[nodiscard]] const Rgba& at(Pixel p) const { return pixels_.at(static_cast<std::size_t>(p.y * width_ + p.x)); }
  /// Mean of a square of pixels.
  [[nodiscard]] Color mean(Pixel middle, int half) const {
    Color sum(0, 0, 0);
    int count = 0;
    for (int y = middle.y - half; y <= middle.y + half; ++y)
      for (int x = middle.x - half; x <= middle.x + half; ++x, ++count) {
        const Rgba& p = at({x, y});
        sum += Color(p.r, p.g, p.b);
      }
    return sum / static_cast<float>(count);
  }
  /// Two tiles look alike, quarter by quarter.
  void expect_alike(Pixel a, Pixel b, int half, float tolerance) const {
    const int step = half / 2;
    for (int dy = -step; dy <= step; dy += 2 * step)
      for (int dx = -step; dx <= step; dx += 2 * step) {
        const Color one = mean({a.x + dx, a.y + dy}, step), other = mean({b.x + dx, b.y + dy}, step);
        for (int channel = 0; channel < 3; ++channel)
          EXPECT_NEAR(one[channel], other[channel], tolerance) << "tiles at " << a.x << "," << a.y << " and " << b.x;
      }
  }
  [[nodiscard]] std::size_t red_pixels() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(pixels_, [](const Rgba& p) { return p.r > 0.15F && p.g < p.r / 3 && p.b < p.r / 3; }));
  }
  /// A green mark on light grey.
  void expect_check_mark(Pixel middle, int half) const {
    int green = 0;
    for (int y = middle.y - half; y <= middle.y + half; ++y)
      for (int x = middle.x - half; x <= middle.x + half; ++x)
        if (const Rgba& p = at({x, y}); p.g > 0.1F && p.r < p.g / 3 && p.b < p.g / 3) ++green;
    EXPECT_GT(green, half * half / 4) << "no check mark at " << middle.x << "," << middle.y;
  }

  std::vector<Rgba> pixels_;
  int width_ = 0;
};

TEST_F(Conformance, negative_scale) {
  render("khronos-small/NegativeScaleTest/glTF-Binary/NegativeScaleTest.glb", "0,0,14:0,0,0:45", 480, 480);
  EXPECT_EQ(red_pixels(), 0U) << "a red cross";
  for (const int y : {129, 178})
    for (const int x : {241, 318, 398}) expect_check_mark({x, y}, 15);
  for (const int x : {282, 364}) EXPECT_GT(at({x - 4, 278}).g, 0.3F) << "the white ball is lit from outside";
}

TEST_F(Conformance, texture_settings) {
  render("khronos-small/TextureSettingsTest/glTF-Binary/TextureSettingsTest.glb", "0,0,15:0,0,0:45", 640, 640);
  EXPECT_EQ(red_pixels(), 0U) << "a red cross";
  for (const int y : {189, 242, 296, 349, 403, 456, 509, 562}) expect_alike({343, y}, {454, y}, 18, 0.05F);
}

TEST_F(Conformance, texture_transforms_of_every_slot_and_both_sets) {
  const char* const file = "texture-transform-multi-test/TextureTransformMultiTest.glb";
  render(file, "0,-0.25,3:0,-0.25,0:50", 480, 480);
  EXPECT_EQ(red_pixels(), 0U) << "a crossed-out circle";
  for (const int y : {69, 111, 197, 240, 283, 328, 370, 412})
    for (const int x : {257, 300}) expect_alike({x, y}, {343, y}, 12, 0.07F);
  // Normals from nearer: the three maps have their levels at other distances.
  render(file, "0.2,0.22,0.75:0.2,0.22,0:50", 900, 500);
  for (const int x : {378, 557}) expect_alike({x, 228}, {735, 228}, 60, 0.05F);
}

TEST_F(Conformance, morphed_primitives) {
  const char* const file = "khronos-more/MorphPrimitivesTest/glTF-Binary/MorphPrimitivesTest.glb";
  render(file, "0,2.5,0.01:0,0,0:45", 480, 480);
  for (const Pixel quarter : {Pixel{182, 182}, Pixel{182, 298}, Pixel{298, 298}})
    EXPECT_GT(mean(quarter, 30).x, 3 * mean(quarter, 30).y) << quarter.x << "," << quarter.y;
  EXPECT_GT(mean({298, 182}, 30).y, 3 * mean({298, 182}, 30).x);
  render(file, "0,0.2,4:0,0.2,0:20", 480, 480);  // from the side: half raised in the middle
  EXPECT_EQ(at({240, 285}).a, 1);
  EXPECT_EQ(at({240, 265}).a, 0);
  EXPECT_EQ(at({60, 285}).a, 0);
}

TEST_F(Conformance, a_morph_of_sparse_targets_at_rest) {
  render("khronos-small/SimpleMorph/glTF/SimpleMorph.gltf", "0.5,1,5:0.5,1,0:40", 480, 480);
  EXPECT_EQ(at({240, 200}).a, 1);
  EXPECT_EQ(at({240, 170}).a, 0);
  EXPECT_EQ(at({185, 365}).a, 1);
  EXPECT_EQ(at({170, 250}).a, 0);
}

TEST_F(Conformance, skins_in_their_bind_poses) {
  render("khronos-small/RiggedSimple/glTF-Binary/RiggedSimple.glb", "auto", 480, 360);
  for (const Pixel inside : {Pixel{240, 20}, Pixel{240, 180}, Pixel{240, 320}, Pixel{215, 320}, Pixel{265, 320}})
    EXPECT_EQ(at(inside).a, 1) << inside.x << "," << inside.y;
  for (const Pixel outside : {Pixel{215, 60}, Pixel{265, 60}, Pixel{150, 180}, Pixel{330, 180}})
    EXPECT_EQ(at(outside).a, 0) << outside.x << "," << outside.y;
  EXPECT_GT(at({230, 180}).g, at({230, 180}).r) << "green";
  render("recursive-skeletons/RecursiveSkeletons.glb", "auto", 480, 480);
  for (const Pixel column : {Pixel{130, 280}, Pixel{220, 240}, Pixel{258, 330}, Pixel{340, 280}})
    EXPECT_EQ(at(column).a, 1) << column.x << "," << column.y;
  for (const Pixel between : {Pixel{180, 280}, Pixel{300, 280}, Pixel{420, 280}})
    EXPECT_EQ(at(between).a, 0) << between.x << "," << between.y;
}

}  // namespace
}  // namespace relook
