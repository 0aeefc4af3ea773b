// Emitting triangles as a light: densities, a closed form, what is never chosen, and the mean of an image over a
// triangle.
#include "light/emission_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "hammersley.h"
#include "pi.h"

namespace relook {
namespace {

/// A rectangle [0, a] x [0, b] at height 1 that shines down.
std::vector<EmissionTriangle> rectangle(float a, float b) {
  const Point o(0, 1, 0), x(a, 1, 0), z(0, 1, b), far(a, 1, b);
  return {{{o, x, z}}, {{x, far, z}}};
}

/// What share of all a surface element below its corner (0, 0, 0), facing it, gets from that rectangle (Howell, A
/// Catalog of Radiation Heat Transfer Configuration Factors, B-3).
double corner_factor(double a, double b) {
  const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * kPi);
}

/// The same by samples.
double sampled_factor(const EmissionLight& light, std::uint32_t points) {
  double sum = 0;
  for (std::uint32_t i = 0; i < points; ++i)
    if (const auto emitter = light.sample({0, 0, 0}, hammersley_point(i, points)))
      sum += static_cast<double>(emitter->way.y / emitter->density) / kPi / points;
  return sum;
}

TEST(EmissionLight, SquareGivesTheClosedForm) {
  for (const float size : {0.1F, 1.0F, 3.0F}) {
    const double expected = corner_factor(static_cast<double>(size), static_cast<double>(size));
    EXPECT_NEAR(sampled_factor(EmissionLight(rectangle(size, size)), 1 << 14) / expected, 1, 2e-3) << size;
  }
  // Means steer where points are, not what they add up to.
  std::vector<EmissionTriangle> uneven = rectangle(2, 1);
  uneven[0].mean = 0;
  uneven[1].mean = 7;
  EXPECT_NEAR(sampled_factor(EmissionLight(uneven), 1 << 16) / corner_factor(2, 1), 1, 5e-3);
}

TEST(EmissionLight, DensityIntegratesToOne) {
  std::vector<EmissionTriangle> triangles = rectangle(1, 2);
  triangles.push_back({{Point(3, 0, 1), Point(4, 1, 1), Point(3, 2, 2)}, 5, true});
  const EmissionLight light(triangles);
  const Point from(0.3F, -0.5F, 0.4F);
  // Over even points of each triangle, steradians are area x cosine / distance^2.
  double sum = 0;
  constexpr std::uint32_t kPoints = 1 << 14;
  for (std::uint32_t k = 0; k < triangles.size(); ++k) {
    const auto& at = triangles[k].at;
    const Direction normal = (at[1] - at[0]).cross(at[2] - at[0]);
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const Uv u = hammersley_point(i, kPoints);
      const float root = std::sqrt(u.x);
      const Direction to = at[0] * (1 - root) + at[1] * (root * (1 - u.y)) + at[2] * (root * u.y) - from;
      const float distance = to.length();
      const float steradians = std::fabs(normal.dot(to)) / 2 / (distance * distance * distance);
      sum += static_cast<double>(light.density(k, from, to / distance, distance) * steradians) / kPoints;
    }
  }
  EXPECT_NEAR(sum, 1, 1e-3);
}

TEST(EmissionLight, SamplesFollowTheirDensity) {
  std::vector<EmissionTriangle> triangles = rectangle(1, 1);
  triangles[1].mean = 3;
  const EmissionLight light(triangles);
  const Point from(0.2F, 0, 0.6F);
  constexpr std::uint32_t kPoints = 1 << 14;
  std::array<double, 8> shares{};  // by triangle and which corner is nearest, or none
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const auto emitter = light.sample(from, hammersley_point(i, kPoints));
    ASSERT_TRUE(emitter);
    const auto& [a, b, c] = triangles[emitter->triangle].at;
    const float b0 = 1 - emitter->b1 - emitter->b2;
    ASSERT_TRUE(emitter->b1 >= 0 && emitter->b2 >= 0 && b0 > -1e-6F);
    EXPECT_LT((a * b0 + b * emitter->b1 + c * emitter->b2 - emitter->at).length(), 1e-6F);
    EXPECT_LT((from + emitter->way * emitter->distance - emitter->at).length(), 1e-6F);
    EXPECT_EQ(emitter->density, light.density(emitter->triangle, from, emitter->way, emitter->distance));
    const std::size_t part = b0 > 0.5F ? 0 : (emitter->b1 > 0.5F ? 1 : (emitter->b2 > 0.5F ? 2 : 3));
    shares[emitter->triangle * 4 + part] += 1.0 / kPoints;
  }
  // 0.9 x 1/4 + 0.1 x 1/2, and a quarter of it in each part.
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(shares[i], (i < 4 ? 0.275 : 0.725) / 4, 2e-3) << i;
}

TEST(EmissionLight, BacksAreDarkUnlessTwoSided) {
  std::vector<EmissionTriangle> triangles = rectangle(1, 1);
  const Point above(0.2F, 2, 0.3F);
  const Direction down(0, -1, 0), up(0, 1, 0);
  const EmissionLight one_sided(triangles);
  for (std::uint32_t i = 0; i < 16; ++i) EXPECT_FALSE(one_sided.sample(above, hammersley_point(i, 16)));
  EXPECT_EQ(one_sided.density(0, above, down, 1), 0);
  EXPECT_GT(one_sided.density(0, {0.2F, 0, 0.3F}, up, 1), 0);
  for (EmissionTriangle& triangle : triangles) triangle.two_sided = true;
  const EmissionLight two_sided(triangles);
  for (std::uint32_t i = 0; i < 16; ++i) EXPECT_TRUE(two_sided.sample(above, hammersley_point(i, 16)));
  EXPECT_EQ(two_sided.density(0, above, down, 1), two_sided.density(0, {0.2F, 0, 0.3F}, up, 1));
  // From its own plane and from a point of its own.
  EXPECT_FALSE(two_sided.sample({5, 1, 0.5F}, {0.3F, 0.3F}));
  const auto emitter = two_sided.sample(above, {0.3F, 0.3F});
  EXPECT_FALSE(two_sided.sample(emitter->at, {0.3F, 0.3F}));
}

TEST(EmissionLight, WhatCannotShineIsNeverChosen) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(EmissionLight({}).empty());
  EXPECT_FALSE(EmissionLight({}).sample({0, 0, 0}, {0.5F, 0.5F}));
  const Point p(1, 2, 3);
  const std::vector<EmissionTriangle> bad{{{p, p, p}},
                                          {{p, p * 2, p * 3}},
                                          {{p, Point(kNan, 0, 0), Point(0, 1, 0)}},
                                          {{p, Point(kInfinity, 0, 0), Point(0, 1, 0)}}};
  EXPECT_TRUE(EmissionLight(bad).empty());
  std::vector<EmissionTriangle> mixed = rectangle(1, 1);
  mixed[0].mean = kNan;
  mixed.insert(mixed.begin() + 1, bad.begin(), bad.end());
  mixed.insert(mixed.begin(), bad.begin(), bad.end());
  const EmissionLight light(mixed);
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const auto emitter = light.sample({0, 0, 0}, hammersley_point(i, 4096));
    ASSERT_TRUE(emitter);
    ASSERT_TRUE(emitter->triangle == 4 || emitter->triangle == mixed.size() - 1) << emitter->triangle;
    ASSERT_TRUE(std::isfinite(emitter->density));
  }
  EXPECT_NEAR(sampled_factor(light, 1 << 16) / corner_factor(1, 1), 1, 3e-3);
  for (std::uint32_t k = 0; k < 4; ++k) EXPECT_EQ(light.density(k, {0, 0, 0}, Direction(0, 1, 0), 1), 0);
  // Black means: by area alone.
  for (EmissionTriangle& triangle : mixed) triangle.mean = 0;
  EXPECT_NEAR(sampled_factor(EmissionLight(mixed), 1 << 14) / corner_factor(1, 1), 1, 3e-3);
}

TEST(EmissionLight, ManySmallTrianglesAreAllMet) {
  // Hundreds of thousands of triangles, each chosen by less than the last bit of a number.
  constexpr std::uint32_t kMany = 1 << 18;
  std::vector<EmissionTriangle> triangles = rectangle(1, 1);
  for (std::uint32_t i = 0; i < kMany; ++i) {
    const float x = static_cast<float>(i) / kMany;
    triangles.push_back({{Point(x, 1, 2), Point(x + 1.0F / kMany, 1, 2), Point(x, 1, 2.1F)}, 0});
  }
  const EmissionLight light(triangles);
  std::set<std::uint32_t> met;
  for (std::uint32_t x = 0; x < 64; ++x)
    for (std::uint32_t y = 0; y < 16; ++y)
      if (const auto emitter =
              light.sample({0, 0, 0}, {0.999F + static_cast<float>(x) * 0x1p-24F, static_cast<float>(y) * 0x1p-16F}))
        met.insert(emitter->triangle);
  ASSERT_GT(met.size(), 100U);
  EXPECT_EQ(*met.rbegin() - *met.begin() + 1, met.size()) << "some are left out";
}

TEST(EmissionLight, MeanLuminanceOfATriangle) {
  // Left half black, right half white.
  std::vector<float> texels;
  for (int i = 0; i < 64 * 64; ++i) texels.insert(texels.end(), 4, i % 64 < 32 ? 0.0F : 1.0F);
  const TexturePyramid image = build_pyramid(64, 64, std::move(texels));
  const TextureSampler clamp{Wrap::clamp, Wrap::clamp};
  const auto mean = [&](Uv a, Uv b, Uv c) { return mean_luminance(image, {a, b, c}, clamp); };
  EXPECT_NEAR(mean({0.55F, 0.1F}, {0.95F, 0.1F}, {0.95F, 0.9F}), 1, 0.05);
  EXPECT_NEAR(mean({0.05F, 0.1F}, {0.45F, 0.1F}, {0.05F, 0.9F}), 0, 0.05);
  EXPECT_NEAR(mean({0, 0}, {1, 0}, {1, 1}), 0.75, 0.1);
  EXPECT_NEAR(mean({0.3F, 0.5F}, {0.3F, 0.5F}, {0.3F, 0.5F}), 0, 1e-6);
  EXPECT_NEAR(mean({0, 0.5F}, {1, 0.5F}, {1, 0.51F}), 0.75, 0.2) << "long and thin";
  EXPECT_NEAR(mean_luminance(image, {Uv(0, 0), Uv(9, 0), Uv(0, 9)}, {}), 0.5, 0.01) << "tiled";
  EXPECT_EQ(mean({0, 0}, {1, 0}, {1, 1}), mean({0, 0}, {1, 0}, {1, 1}));
  std::vector<float> negative(4 * 4 * 4, -1.0F);
  EXPECT_EQ(mean_luminance(build_pyramid(4, 4, std::move(negative)), {Uv(0, 0), Uv(1, 0), Uv(0, 1)}, {}), 0);
}

}  // namespace
}  // namespace relook
