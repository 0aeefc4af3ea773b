// Layers of a tile add up to the pixels that compose() gives, one by one, whatever colours they had before.
#include "image/tile_layers.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "base/parallel.h"

namespace relook {
namespace {

constexpr std::size_t kPixels = 37;  // no multiple of a vector
using Colors = std::vector<LightColor>;

/// Four sums: the first of 8 bytes a value at most, the second of more, the third without light, the fourth negative.
PackedSums some_sums(std::uint32_t seed = 7) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  TileSums sums(4, kPixels);
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
    const auto color = [&](float size) { return Color(uniform(random), uniform(random), uniform(random)) * size; };
    for (int term = 0; term < 5; ++term) {
      sums.add(0, pixel, Color(std::round(uniform(random) * 1000), 2, 0.25F));
      sums.add(1, pixel, color(1e5F));
      sums.add(1, pixel, color(1e-9F));
      sums.add(3, pixel, color(-0.1F));
    }
    sums.add_coverage(pixel, uniform(random));
  }
  return PackedSums::pack(sums);
}

void expect_pixels(TileLayers& layers, const PackedSums& sums, const Colors& colors, std::uint32_t samples) {
  TileLayers::Working working;
  const TileLayers::Planes planes = layers.compose(sums, colors, samples, working);
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
    const Rgba color = compose(sums, pixel, colors, samples);
    const float of_color[] = {color.r, color.g, color.b, color.a};
    for (std::size_t channel = 0; channel < planes.size(); ++channel)
      EXPECT_EQ(std::bit_cast<std::uint32_t>(planes[channel][pixel]), std::bit_cast<std::uint32_t>(of_color[channel]))
          << pixel << " " << channel;
  }
}

TEST(TileLayers, give_the_pixels_of_any_colours_after_any_others) {
  set_float_mode();
  const PackedSums sums = some_sums();
  EXPECT_LE(sums.shapes()[0].width, 8);
  EXPECT_GT(sums.shapes()[1].width, 8);
  for (const std::uint32_t samples : {1U, 7U, 64U}) {
    TileLayers layers;
    EXPECT_TRUE(layers.empty());
    Colors colors{{1, 0.3, 7}, {0.1, 0.2, 0.3}, {5, 5, 5}, {1, 1, 1}};
    expect_pixels(layers, sums, colors, samples);
    colors[1] = {3, 0, 1.0 / 3};
    expect_pixels(layers, sums, colors, samples);
    const Colors before = colors;
    colors[0] = colors[3] = {0, 0, 0};  // solo
    expect_pixels(layers, sums, colors, samples);
    expect_pixels(layers, sums, before, samples);
    colors[0] = {-1, 1e-30, 1e30};
    expect_pixels(layers, sums, colors, samples);
    for (LightColor& color : colors) color = {0, 0, 0};
    expect_pixels(layers, sums, colors, samples);
  }
}

TEST(TileLayers, know_what_they_show) {
  const PackedSums sums = some_sums();
  Colors colors(4, {1, 1, 1});
  TileLayers layers;
  TileLayers::Working working;
  EXPECT_FALSE(layers.shows(colors));
  static_cast<void>(layers.compose(sums, colors, 4, working));
  EXPECT_TRUE(layers.shows(colors));
  colors[2] = {0, 2, 0};  // of a light that the tile has none of
  EXPECT_TRUE(layers.shows(colors));
  colors[3] = {1, 1, 0.5};
  EXPECT_FALSE(layers.shows(colors));
  static_cast<void>(layers.compose(sums, colors, 4, working));
  EXPECT_TRUE(layers.shows(colors));
  EXPECT_FALSE(layers.shows(Colors(3)));
}

TEST(TileLayers, that_forget_are_those_of_other_sums) {
  TileLayers layers;
  const Colors colors(4, {2, 3, 4});
  expect_pixels(layers, some_sums(), colors, 2);
  layers.forget();
  EXPECT_TRUE(layers.empty());
  expect_pixels(layers, some_sums(8), colors, 2);
}

TEST(TileLayers, take_room_for_lights_that_are_on) {
  const PackedSums sums = some_sums();
  TileLayers layers;
  EXPECT_EQ(layers.bytes(), 0U);
  TileLayers::Working working;
  static_cast<void>(layers.compose(sums, Colors{{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}}, 4, working));
  const std::size_t one = layers.bytes(), layer_bytes = 3 * kPixels * sizeof(float);
  static_cast<void>(layers.compose(sums, Colors(4, {1, 1, 1}), 4, working));
  EXPECT_EQ(layers.bytes(), one + 2 * layer_bytes);
}

}  // namespace
}  // namespace relook
