// Numbers are stratified within a set, independent between sets, and the same everywhere.
#include "light/point_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "light/point_lanes.h"

namespace relook {
namespace {

constexpr std::array kPurposes{Purpose::pixel, Purpose::lens, Purpose::lobe, Purpose::light, Purpose::coverage};

std::vector<Uv> points_of(std::uint32_t pixel, std::uint64_t history, Purpose purpose, std::uint32_t first,
                          std::uint32_t count) {
  std::vector<Uv> points;
  for (std::uint32_t k = 0; k < count; ++k) points.push_back(sample_point({pixel, first + k}, history, purpose));
  return points;
}

/// Of 2^m points, whether each of the 2^m cells of every shape 2^-i by 2^(i-m) holds one.
bool is_net(const std::vector<Uv>& points, unsigned m) {
  for (unsigned i = 0; i <= m; ++i) {
    std::set<std::pair<int, int>> cells;
    for (const Uv& u : points)
      cells.emplace(static_cast<int>(std::ldexp(u.x, static_cast<int>(i))),
                    static_cast<int>(std::ldexp(u.y, static_cast<int>(m - i))));
    if (cells.size() != points.size()) return false;
  }
  return true;
}

TEST(PointSet, PowersOfTwoAreNets) {
  for (const Purpose purpose : kPurposes)
    for (unsigned m = 0; m <= 12; m += 2)
      for (const std::uint32_t block : {0U, 1U, 5U}) {
        const std::uint32_t count = 1U << m;
        const std::uint64_t history = child_history(m, block);
        ASSERT_TRUE(is_net(points_of(pixel_key(m, block), history, purpose, block * count, count), m)) << m;
      }
  for (std::uint32_t pixel = 0; pixel < 200; ++pixel)
    ASSERT_TRUE(is_net(points_of(pixel_key(pixel, 1), 0, Purpose::light, 0, 64), 6)) << pixel;
}

TEST(PointSet, NumbersFillEveryIntervalOnce) {
  for (std::uint32_t pixel = 0; pixel < 50; ++pixel) {
    std::set<int> cells;
    for (std::uint32_t k = 0; k < 64; ++k)
      cells.insert(static_cast<int>(64 * sample_number({pixel, k}, pixel, Purpose::lobe)));
    EXPECT_EQ(cells.size(), 64U);
  }
}

TEST(PointSet, StaysBelowOne) {
  float largest = 0, smallest = 1;
  for (std::uint32_t k = 0; k < 300000; ++k) {
    const Uv u = sample_point({k, k % 7}, k, Purpose::lobe);
    largest = std::max({largest, u.x, u.y});
    smallest = std::min({smallest, u.x, u.y});
  }
  EXPECT_LT(largest, 1);
  EXPECT_GT(largest, 0.99999F);
  EXPECT_GE(smallest, 0);
  EXPECT_LT(smallest, 0.00001F);
}

/// Sums over pairs of numbers that should be independent and uniform.
struct Pairs {
  double n = 0, a = 0, b = 0, ab = 0, same_half = 0;
  void add(float x, float y) {
    n += 1;
    a += x - 0.5;
    b += y - 0.5;
    ab += (x - 0.5) * (y - 0.5);
    same_half += (x < 0.5F) == (y < 0.5F) ? 1 : -1;
  }
  /// Means of 0, within 5 deviations of a mean of n independent numbers.
  void expect_independent() const {
    EXPECT_LT(std::fabs(a), 5 * std::sqrt(n / 12));
    EXPECT_LT(std::fabs(b), 5 * std::sqrt(n / 12));
    EXPECT_LT(std::fabs(ab), 5 * std::sqrt(n) / 12);
    EXPECT_LT(std::fabs(same_half), 5 * std::sqrt(n));
  }
};

TEST(PointSet, SetsAreIndependent) {
  constexpr std::uint32_t kPixels = 20000;
  // Whatever differs between two sets, for samples of the same number and of others.
  for (const std::uint32_t other : {0U, 1U, 3U}) {
    Pairs purposes, histories, names, pixels, within, kinds;
    for (std::uint32_t p = 0; p < kPixels; ++p) {
      const std::uint32_t pixel = pixel_key(p % 200, p / 200), k = p % 4;
      const Uv u = sample_point({pixel, k}, 0, Purpose::lobe);
      purposes.add(u.x, sample_point({pixel, k ^ other}, 0, Purpose::light).x);
      histories.add(u.y, sample_point({pixel, k ^ other}, child_history(0, 1), Purpose::lobe).y);
      names.add(u.x, sample_point({pixel, k ^ other}, 0, Purpose::lobe, 1).x);
      pixels.add(u.y, sample_point({pixel_key(p % 200 + 1, p / 200), k ^ other}, 0, Purpose::lobe).y);
      within.add(u.x, u.y);
      kinds.add(u.x, sample_number({pixel, k ^ other}, 0, Purpose::lobe));
    }
    for (const Pairs& pairs : {purposes, histories, names, pixels, within, kinds}) pairs.expect_independent();
  }
}

TEST(PointSet, SamplesOfAPixelArePairedAtRandomBetweenSets) {
  // Over the 64 samples of one pixel two sets are not paired cell by cell (1 would be 64): the square of their
  // correlation is that of random pairings but for the first digits, which scrambling the index swaps in pairs of
  // samples. They bring 9/16 of the variance, twice.
  double sum = 0;
  constexpr int kPixels = 2000;
  for (std::uint32_t p = 0; p < kPixels; ++p) {
    double ab = 0;
    for (std::uint32_t k = 0; k < 64; ++k)
      ab += (sample_point({p, k}, 7, Purpose::lobe).x - 0.5) * (sample_point({p, k}, 7, Purpose::light).x - 0.5);
    sum += ab * ab * (144.0 / 64);
  }
  EXPECT_NEAR(sum / kPixels, 1 + 9.0 / 16, 0.25);
}

TEST(PointSet, SixtyFourPointsIntegrateBetterThanRandomOnes) {
  double squared = 0;
  constexpr int kPixels = 1000;
  for (std::uint32_t p = 0; p < kPixels; ++p) {
    double mean = 0;
    for (const Uv& u : points_of(pixel_key(p, 3), 0, Purpose::light, 0, 64)) mean += double{u.x} * u.y / 64;
    squared += (mean - 0.25) * (mean - 0.25) / kPixels;
  }
  const double random = (1.0 / 9 - 1.0 / 16) / 64;  // variance of a mean of 64 products
  EXPECT_LT(squared, random / 20);
}

TEST(PointSet, HasTheseBits) {
  const auto bits = [](float x) { return static_cast<std::uint32_t>(x * 0x1p24F); };
  const auto point = [&](const SampleKey& key, std::uint64_t history, Purpose purpose, std::uint64_t name) {
    const Uv u = sample_point(key, history, purpose, name);
    return std::pair(bits(u.x), bits(u.y));
  };
  using Bits = std::pair<std::uint32_t, std::uint32_t>;
  EXPECT_EQ(point({0, 0}, 0, Purpose::pixel, 0), Bits(0x9E3F06, 0xBE9740));
  EXPECT_EQ(point({pixel_key(3, 5), 17}, child_history(0, 2), Purpose::light, name_hash("key")),
            Bits(0xD7CE2, 0x9C0773));
  EXPECT_EQ(bits(sample_number({1, 4095}, 9, Purpose::coverage)), 0xE9AC5CU);
  EXPECT_EQ(pixel_key(3, 5), 0xBC312E6FU);
  EXPECT_EQ(name_hash("key"), 0xBBEA0D63A05165E3U);
  EXPECT_EQ(child_history(0, 2), 0x6C45D188009454FU);
}

TEST(PointSet, LanesHaveTheBitsOfSinglePoints) {
  PointKeys keys;
  for (std::uint32_t lane = 0; lane < kPointLanes; ++lane)
    keys.set(lane, {pixel_key(lane, 3 * lane), 1000 * lane + 7}, child_history(lane % 5, lane));
  for (const Purpose purpose : kPurposes) {
    PointLanes points;
    sample_points(keys, purpose, name_hash("light/a"), points);
    for (std::size_t lane = 0; lane < kPointLanes; ++lane)
      EXPECT_EQ(points.at(lane), sample_point({keys.pixel[lane], keys.sample[lane]}, keys.history[lane], purpose,
                                              name_hash("light/a")));
  }
}

TEST(PointSet, PixelsHaveKeysOfTheirOwn) {
  std::set<std::uint32_t> keys;
  for (std::uint32_t y = 0; y < 300; ++y)
    for (std::uint32_t x = 0; x < 300; ++x) keys.insert(pixel_key(200 * x, 200 * y));
  EXPECT_EQ(keys.size(), 90000U);
}

TEST(PointSet, BranchesHaveHistoriesOfTheirOwn) {
  std::set<std::uint64_t> histories{0};
  for (std::uint32_t a = 0; a < 30; ++a)
    for (std::uint32_t b = 0; b < 30; ++b) {
      histories.insert(child_history(child_history(0, a), b));
      histories.insert(child_history(child_history(child_history(0, 0), a), b));
    }
  EXPECT_EQ(histories.size(), 1U + 900 + 900);
}

TEST(PointSet, WhatAChoiceLeavesIsUniform) {
  constexpr std::array kShares{0.125F, 0.5F, 0.0F, 0.3F, 0.075F};
  std::array<std::array<int, 10>, kShares.size()> counts{};
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const float number = (static_cast<float>(i) + 0.5F) / kCount;
    float first = 0;
    std::size_t chosen = 0;
    while (chosen + 1 < kShares.size() && number >= first + kShares[chosen]) first += kShares[chosen++];
    const float left = remapped(number, first, kShares[chosen]);
    ASSERT_TRUE(left >= 0 && left < 1);
    ++counts[chosen][static_cast<std::size_t>(10 * left)];
  }
  for (std::size_t i = 0; i < kShares.size(); ++i)
    for (const int count : counts[i]) EXPECT_NEAR(count, kShares[i] * kCount / 10, 2) << i;
  EXPECT_LT(remapped(0.75F, 0.5F, 0.25F), 1);
  EXPECT_EQ(remapped(0.5F, 0.5F, 0), 0);
  EXPECT_EQ(remapped(0.25F, 0.5F, 0.5F), 0);
}

}  // namespace
}  // namespace relook
