// KHR_materials_dispersion: each channel of a picture is that of glass with the channel's own index of refraction.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "edit/apply.h"
#include "test_scenes.h"
#include "tree_reader.h"

namespace relook {
namespace {

/// The spheres, from where the glass fills much of the picture, or from inside of it.
SceneState glass_scene(bool from_inside, double ior, double dispersion) {
  SceneState state = spheres_scene(60, 45);
  SceneBuilder view;
  if (from_inside)
    view.look_at(Point(1.4F, 0.5F, 0.7F), Point(0, 0.7F, -0.7F), 100, 60, 45);
  else
    view.look_at(Point(1.5F, 1.2F, 2.4F), Point(1.2F, 0.66F, 0.5F), 40, 60, 45);
  SceneState seen = with_camera(state, view.camera());
  (void)apply_edit(seen, replace_edit("/materials/Glass/extensions/KHR_materials_ior/ior", ior), "", ".");
  (void)apply_edit(seen, replace_edit("/materials/Glass/extensions/KHR_materials_dispersion/dispersion", dispersion),
                   "", ".");
  return seen;
}

std::size_t pixels_that_differ(const Frame& a, const Frame& b, int channel) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    different +=
        std::bit_cast<std::uint32_t>(a.pixels[i][channel]) != std::bit_cast<std::uint32_t>(b.pixels[i][channel]);
  return different;
}

TEST(Dispersion, each_channel_is_that_of_its_own_index) {
  constexpr float kIndex = 1.7F, kStrength = 5;
  const ViewOptions view{1, 3, 0};  // so few generations that the Fresnel cut-off takes nothing
  for (const bool from_inside : {false, true}) {
    SCOPED_TRACE(from_inside ? "from inside" : "from outside");
    const Frame parted = rendered(glass_scene(from_inside, kIndex, kStrength).scene(), view);
    const Frame white = rendered(glass_scene(from_inside, kIndex, 0).scene(), view);
    for (int channel = 0; channel < 3; ++channel) {
      const float half_spread = (kIndex - 1) * (0.025F * kStrength);
      const float index = kIndex + static_cast<float>(channel - 1) * half_spread;
      const Frame alone = rendered(glass_scene(from_inside, index, 0).scene(), view);
      EXPECT_EQ(pixels_that_differ(parted, alone, channel), 0U) << "channel " << channel;
      if (channel == 1)
        EXPECT_EQ(pixels_that_differ(parted, white, channel), 0U);
      else
        EXPECT_GT(pixels_that_differ(parted, white, channel), parted.pixels.size() / 4);
    }
  }
}

/// Rays that come back to one channel are counted; no ray below one parts again.
void count_parted(const TreeNode& node, bool is_parted, std::size_t& parted, bool& parts_again) {
  for (const auto& [branch, child] : node.children) {
    const bool parts = branch >= Branch::refracted_red && branch <= Branch::refracted_blue;
    parted += parts ? 1 : 0;
    parts_again = parts_again || (parts && is_parted);
    count_parted(child, is_parted || parts, parted, parts_again);
  }
}

TEST(Dispersion, colours_part_once) {
  for (const bool from_inside : {false, true})
    for (const double dispersion : {0.0, 5.0}) {
      const SceneState state = glass_scene(from_inside, 1.5, dispersion);
      const Image image = preprocessed(state.scene(), {1, 6, 0});
      std::size_t parted = 0;
      bool parts_again = false;
      for (std::size_t tile = 0; tile < image.trees.size(); ++tile)
        for (std::size_t sample = 0; sample < image.trees[tile].paths.size(); ++sample)
          count_parted(read_tree(image, tile, sample, state.scene().light_order.size()), false, parted, parts_again);
      EXPECT_EQ(parted > 1000, dispersion > 0) << parted;
      EXPECT_FALSE(parts_again);
    }
}

TEST(Dispersion, indices_below_1_are_1_and_an_index_of_0_does_not_part) {
  // (3 - 1) 0.025 * 100 = 5: red would have index -2.
  const ViewOptions view{1, 3, 0};
  const Frame strong = rendered(glass_scene(false, 3, 100).scene(), view);
  EXPECT_EQ(pixels_that_differ(strong, rendered(glass_scene(false, 8, 0).scene(), view), 2), 0U);
  for (const Rgba& pixel : strong.pixels) EXPECT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b));
  EXPECT_EQ(different_pixels(rendered(glass_scene(false, 0, 100).scene(), view),
                             rendered(glass_scene(false, 0, 0).scene(), view))
                .size(),
            0U);
}

}  // namespace
}  // namespace relook
