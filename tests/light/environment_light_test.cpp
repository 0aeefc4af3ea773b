// Sky and suns of an environment image: the threshold between them, the suns' distribution, on made images and on the
// real ones beside the project, in ../shared/assets/hdri; without that folder their test skips and says so.
#include "light/environment_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include "base/files.h"
#include "hammersley.h"
#include "light/luminance.h"
#include "pi.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
using SkyImage = std::shared_ptr<const TexturePyramid>;

SkyImage image_of(std::uint32_t width, std::uint32_t height,
                  const std::function<Color(std::uint32_t, std::uint32_t)>& texel) {
  std::vector<float> texels;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const Color c = texel(x, y);
      texels.insert(texels.end(), {c.x, c.y, c.z, 1});
    }
  return std::make_shared<const TexturePyramid>(build_pyramid(width, height, std::move(texels)));
}

/// A colour of all but black, and texels of `hot` luminance at these places.
SkyImage image_with_suns(std::uint32_t width, std::uint32_t height, float hot,
                         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& places) {
  return image_of(width, height, [&, random = std::mt19937(3)](std::uint32_t x, std::uint32_t y) mutable {
    const auto next = [&] { return static_cast<float>(random() % 1000) / 1000; };
    const Color sky(0.5F + next(), 0.5F + next(), 0.5F + next());
    return std::ranges::find(places, std::pair{x, y}) == places.end() ? sky : Color(hot, hot * 0.9F, hot * 0.7F);
  });
}

/// Suns in a row, alone, over the seam and at both poles.
SkyImage hard_image() {
  return image_with_suns(40, 20, 900, {{7, 5}, {8, 5}, {8, 6}, {0, 12}, {39, 11}, {20, 0}, {3, 19}, {4, 19}});
}

Color texel_at(const TexturePyramid& image, std::uint32_t x, std::uint32_t y) {
  const auto& [width, height, offset] = image.levels[0];
  const Uv uv((static_cast<float>(x) + 0.5F) / static_cast<float>(width),
              (static_cast<float>(y) + 0.5F) / static_cast<float>(height));
  const Rgba c = sample(image, uv, 0, {Wrap::repeat, Wrap::clamp});
  return {std::max(c.r, 0.0F), std::max(c.g, 0.0F), std::max(c.b, 0.0F)};
}

/// The solid-angle mean of value(L) over the texels.
double mean_of(const TexturePyramid& image, const std::function<double(double)>& value) {
  const auto& [width, height, offset] = image.levels[0];
  double sum = 0, weight = 0;
  for (std::uint32_t y = 0; y < height; ++y) {
    const double sine = std::sin((y + 0.5) / height * kPi);
    for (std::uint32_t x = 0; x < width; ++x)
      sum += sine * value(static_cast<double>(luminance(texel_at(image, x, y))));
    weight += sine * width;
  }
  return sum / weight;
}

void expect_fixed_point(const TexturePyramid& image, float threshold) {
  const auto t = static_cast<double>(threshold);
  EXPECT_NEAR(4 * mean_of(image, [t](double l) { return std::min(l, t); }), t, 1e-5 * t);
}

/// Integrates value(way) over the sphere, by `fine` x `fine` places a texel.
double integral(const TexturePyramid& image, std::uint32_t fine, const std::function<double(const Direction&)>& value) {
  const std::uint32_t width = image.levels[0].width * fine, height = image.levels[0].height * fine;
  double sum = 0;
  for (std::uint32_t y = 0; y < height; ++y) {
    const double v = (y + 0.5) / height, sine = std::sin(v * kPi);
    double row = 0;
    for (std::uint32_t x = 0; x < width; ++x) row += value(environment_way((x + 0.5) / width, v));
    sum += row * sine;
  }
  return sum * 2 * kPi * kPi / width / height;
}

std::vector<Direction> random_ways(int count) {
  std::mt19937 random(11);
  std::normal_distribution<float> normal;
  std::vector<Direction> ways;
  for (int i = 0; i < count; ++i) {
    const float x = normal(random), y = normal(random), z = normal(random);
    ways.push_back(Direction(x, y, z).normalized());
  }
  for (const float s : {1.0F, -1.0F}) ways.insert(ways.end(), {{s, 0, 0}, {0, s, 0}, {0, 0, s}});
  return ways;
}

TEST(EnvironmentLight, DirectionsAreReadWhereTheyComeFrom) {
  EXPECT_EQ(environment_uv({0, 0, -1}), Uv(0.5F, 0.5F));
  EXPECT_NEAR(environment_uv({1, 0, 0}).x, 0.75F, 1e-6F);
  EXPECT_NEAR(environment_uv({0, 1, 0}).y, 0, 1e-6F);
  for (double v = 0.02; v < 1; v += 0.03)
    for (double u = 0.001; u < 1; u += 0.037) {
      const Direction way = environment_way(u, v);
      ASSERT_NEAR(way.length(), 1, 1e-6F);
      ASSERT_NEAR(environment_uv(way).x, u, 2e-6 / std::sin(v * kPi));
      ASSERT_NEAR(environment_uv(way).y, v, 1e-6 / std::sin(v * kPi));
    }
}

TEST(EnvironmentLight, EvenImagesHaveNoSuns) {
  const std::vector<SkyImage> images{nullptr, image_of(8, 4, [](auto, auto) { return Color(2, 3, 4); }),
                                     image_of(1, 1, [](auto, auto) { return Color(1, 0, 0); }),
                                     image_of(8, 4, [](auto, auto) { return Color(0, 0, 0); }),
                                     image_of(8, 4, [](auto, auto) { return Color(-1, -2, -3); })};
  const std::vector<Color> skies{{1, 1, 1}, {2, 3, 4}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (std::size_t i = 0; i < images.size(); ++i) {
    const EnvironmentLight light(images[i]);
    EXPECT_EQ(light.threshold(), kInfinity);
    EXPECT_FALSE(light.has_suns());
    EXPECT_EQ(light.sun_share(), 0);
    EXPECT_EQ(light.negative_share(), i == 4 ? 1 : 0);
    EXPECT_FALSE(light.sample({0.5F, 0.5F}));
    for (const Direction& way : random_ways(50)) {
      EXPECT_EQ(light.density(way), 0);
      EXPECT_LT((light.sky(way) - skies[i]).length(), 1e-6F);
      EXPECT_EQ(light.suns(way), Color(0, 0, 0));
    }
  }
}

TEST(EnvironmentLight, ThresholdIsTheFixedPoint) {
  const SkyImage one = image_with_suns(64, 32, 2048 * 20000.0F, {{30, 9}});
  const EnvironmentLight light(one);
  expect_fixed_point(*one, light.threshold());
  // The sky's own mean is 1: the sun, 20,000 times the mean of all and nearly all of the light, hardly moves it.
  EXPECT_NEAR(light.threshold(), 4, 0.2);
  EXPECT_GT(light.sun_share(), 0.9999);
  expect_fixed_point(*hard_image(), EnvironmentLight(hard_image()).threshold());
}

TEST(EnvironmentLight, AllButBlackHasNoSky) {
  // Light on less than a quarter of the sphere: no t but 0 is four times a mean of min(L, t).
  const SkyImage image = image_of(16, 8, [](auto x, auto) { return x < 3 ? Color(1, 1, 1) : Color(0, 0, 0); });
  const EnvironmentLight light(image);
  EXPECT_EQ(light.threshold(), 0);
  EXPECT_EQ(light.sun_share(), 1);
  for (const Direction& way : random_ways(200)) EXPECT_EQ(light.sky(way), Color(0, 0, 0));
  // On a third of it: t = 4/3 of the light's luminance, so nothing exceeds it.
  EXPECT_FALSE(EnvironmentLight(image_of(12, 8, [](auto x, auto) { return Color(x < 4 ? 1.0F : 0.0F); })).has_suns());
}

TEST(EnvironmentLight, NegativeTexelsCountAsBlack) {
  const auto texel = [](auto x, auto y) { return Color(x == 3 && y == 4 ? 500.0F : (x % 4 == 0 ? -0.25F : 1.0F)); };
  const SkyImage image = image_of(32, 16, texel);
  const EnvironmentLight light(image);
  expect_fixed_point(*image, light.threshold());
  const double positive = mean_of(*image, [](double l) { return l; }), negative = 0.25 * 0.25;
  EXPECT_NEAR(light.negative_share(), negative / (positive + negative), 1e-6);
  for (const Direction& way : random_ways(500)) {
    const auto [sky, suns] = light.parts(way);
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(sky[c] >= 0 && suns[c] >= 0);
  }
}

TEST(EnvironmentLight, PartsAddUpToTheLookup) {
  for (const SkyImage& image : {hard_image(), image_with_suns(64, 32, 20000, {{30, 9}})}) {
    const EnvironmentLight light(image);
    for (const Direction& way : random_ways(3000)) {
      const Rgba all = sample(*image, environment_uv(way), 0, {Wrap::repeat, Wrap::clamp});
      const auto [sky, suns] = light.parts(way);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sky[c] + suns[c], all[c], 1e-6F * all[c]);
      EXPECT_LE(luminance(sky), light.threshold() * 1.000001F);
      EXPECT_NEAR(sky[0] * all[2], sky[2] * all[0], 1e-6F * sky[0] * all[2]) << "another hue";
      EXPECT_TRUE(suns == Color(0, 0, 0) || sky != Color(all.r, all.g, all.b));
    }
  }
}

TEST(EnvironmentLight, DensityIntegratesToOne) {
  const std::vector<SkyImage> images{hard_image(), image_with_suns(64, 32, 20000, {{30, 9}}),
                                     image_with_suns(24, 1, 900, {{3, 0}}), image_with_suns(1, 24, 900, {{0, 5}}),
                                     image_with_suns(16, 8, 5000, {{4, 0}})};
  for (const SkyImage& image : images) {
    const EnvironmentLight light(image);
    ASSERT_TRUE(light.has_suns());
    EXPECT_NEAR(integral(*image, 20, [&](auto& way) { return static_cast<double>(light.density(way)); }), 1, 2e-3);
  }
}

TEST(EnvironmentLight, SamplesFollowTheirDensity) {
  const SkyImage image = hard_image();
  const EnvironmentLight light(image);
  // Shares of 80 x 40 boxes, each a quarter of a texel.
  constexpr std::uint32_t kColumns = 80, kRows = 40, kPoints = 1 << 18, kFine = 8;
  std::vector<double> shares(kColumns * kRows), expected(kColumns * kRows);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const auto sun = light.sample(hammersley_point(i, kPoints));
    ASSERT_TRUE(sun);
    const float density = light.density(sun->way);  // of a direction in floats, whose polar angle next to 0 is coarse
    ASSERT_NEAR(sun->density, density, 1e-3F * std::max(density, 1.0F) + 0.02F * density * std::fabs(sun->way.y)) << i;
    const Uv uv = environment_uv(sun->way);
    const auto x = std::min(static_cast<std::uint32_t>(uv.x * kColumns), kColumns - 1);
    shares[std::min(static_cast<std::uint32_t>(uv.y * kRows), kRows - 1) * kColumns + x] += 1.0 / kPoints;
  }
  for (std::uint32_t y = 0; y < kRows * kFine; ++y)
    for (std::uint32_t x = 0; x < kColumns * kFine; ++x) {
      const double v = (y + 0.5) / (kRows * kFine), u = (x + 0.5) / (kColumns * kFine);
      const double steradians = std::sin(v * kPi) * 2 * kPi * kPi / (kRows * kFine) / (kColumns * kFine);
      expected[y / kFine * kColumns + x / kFine] +=
          static_cast<double>(light.density(environment_way(u, v))) * steradians;
    }
  for (std::size_t i = 0; i < shares.size(); ++i) ASSERT_NEAR(shares[i], expected[i], 0.0005 + 0.01 * expected[i]) << i;
}

TEST(EnvironmentLight, SamplesSideBySideAreThoseOfSinglePoints) {
  const EnvironmentLight light(hard_image()), without(nullptr);
  std::vector<Uv> points;
  for (std::uint32_t i = 0; i < 37; ++i) points.push_back(hammersley_point(i, 37));
  std::vector<std::optional<EnvironmentLight::Sun>> suns(points.size());
  light.sample(points, suns);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto alone = light.sample(points[i]);
    ASSERT_EQ(suns[i].has_value(), alone.has_value());
    if (!alone) continue;
    EXPECT_EQ(suns[i]->way, alone->way);
    EXPECT_EQ(suns[i]->density, alone->density);
  }
  without.sample(points, suns);
  EXPECT_TRUE(std::ranges::none_of(suns, [](const auto& sun) { return sun.has_value(); }));
}

TEST(EnvironmentLight, SamplesEstimateTheSuns) {
  for (const SkyImage& image : {hard_image(), image_with_suns(64, 32, 20000, {{30, 9}})}) {
    const EnvironmentLight light(image);
    // Weighted by a lobe, as at a surface.
    const auto value = [&](const Direction& way) {
      return static_cast<double>(luminance(light.suns(way)) * std::max(way.y * 0.8F + 0.6F * way.x + 1, 0.0F));
    };
    constexpr std::uint32_t kPoints = 1 << 14;
    double sum = 0, squares = 0;
    for (std::uint32_t i = 0; i < kPoints; ++i)
      if (const auto sun = light.sample(hammersley_point(i, kPoints))) {
        const double term = value(sun->way) / static_cast<double>(sun->density);
        sum += term / kPoints;
        squares += term * term / kPoints;
      }
    EXPECT_NEAR(sum / integral(*image, 20, value), 1, 2e-3);
    // One sample knows the suns well: their interpolation is that of the distribution, but for the threshold.
    EXPECT_LT(std::sqrt(squares / (sum * sum) - 1), 0.5);
  }
}

TEST(EnvironmentLight, DensityCoversTheSuns) {
  const SkyImage image = hard_image();
  const EnvironmentLight light(image);
  const double total = integral(*image, 8, [&](auto& way) { return static_cast<double>(luminance(light.suns(way))); });
  std::vector<Direction> ways = random_ways(20000);
  for (int i = 0; i <= 400; ++i)  // over texels' middles and borders
    for (const double v : {0.0, 0.001, 0.025, 0.275, 0.3, 0.575, 0.975, 1.0})
      ways.push_back(environment_way(i / 400.0, v));
  for (const Direction& way : ways) {
    const auto suns = static_cast<double>(luminance(light.suns(way))),
               density = static_cast<double>(light.density(way));
    ASSERT_TRUE(std::isfinite(density));
    // At most the ratio of the sines of neighbouring rows, and what rounding leaves beside the suns.
    ASSERT_LE(suns, 4 * total * density + 1e-4);
  }
}

TEST(EnvironmentLight, BytesAreReadLikeFloats) {
  std::vector<std::uint8_t> bytes(64 * 32 * 4, 3);
  for (std::size_t c = 0; c < 4; ++c) bytes[(9 * 64 + 30) * 4 + c] = 255;
  const auto image =
      std::make_shared<const TexturePyramid>(build_pyramid(TexelFormat::srgb8, 64, 32, std::move(bytes)));
  const EnvironmentLight light(image);
  ASSERT_TRUE(light.has_suns());
  expect_fixed_point(*image, light.threshold());
  EXPECT_NEAR(luminance(light.suns(environment_way(30.5 / 64, 9.5 / 32))), 1 - light.threshold(), 1e-3F);
}

TEST(EnvironmentLight, RealImages) {
  const auto folder = std::filesystem::path(RELOOK_SOURCE_DIR) / "../shared/assets/hdri";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/assets beside the project: NOT tested";
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".exr") files.push_back(entry.path());
  std::ranges::sort(files);
  ASSERT_FALSE(files.empty());
  for (const auto& file : files) {
    const std::string name = file.filename().string();
    const SkyImage image = decode_pyramid(read_file(file), true, name, "");
    const EnvironmentLight light(image);
    std::printf("%-22s %4u x %4u  t / mean %5.2f  suns %4.1f %% of the light\n", name.c_str(), image->levels[0].width,
                image->levels[0].height,
                static_cast<double>(light.threshold()) / mean_of(*image, [](double l) { return l; }),
                100 * light.sun_share());
    if (!light.has_suns()) continue;
    expect_fixed_point(*image, light.threshold());
    const double total =
        integral(*image, 2, [&](auto& way) { return static_cast<double>(luminance(light.suns(way))); });
    EXPECT_NEAR(integral(*image, 1, [&](auto& way) { return static_cast<double>(light.density(way)); }), 1, 0.01);
    constexpr std::uint32_t kPoints = 1 << 14;
    double sum = 0;
    for (std::uint32_t i = 0; i < kPoints; ++i)
      if (const auto sun = light.sample(hammersley_point(i, kPoints)))
        sum += static_cast<double>(luminance(light.suns(sun->way)) / sun->density) / kPoints;
    EXPECT_NEAR(sum / total, 1, 0.01) << name;
  }
}

}  // namespace
}  // namespace relook
