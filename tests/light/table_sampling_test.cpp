// Choices by weights: their shares, what is left of the numbers, and what is never chosen.
#include "light/table_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace relook {
namespace {

TEST(TableSampling, ChoosesByWeight) {
  const std::vector<double> weights{0, 3, 0, 1, 1e-9, 0, 4, 0};
  const DiscreteDistribution distribution(weights);
  constexpr int kNumbers = 1 << 16;
  std::vector<int> counts(weights.size());
  std::uint32_t last = 0;
  for (int i = 0; i < kNumbers; ++i) {
    const double number = (i + 0.5) / kNumbers;
    const auto choice = distribution.choose(number);
    ASSERT_GE(choice.index, last) << "growing numbers choose growing indices";
    last = choice.index;
    ++counts[choice.index];
    ASSERT_EQ(choice.probability, distribution.probability(choice.index));
    ASSERT_GE(choice.rest, 0);
    ASSERT_LT(choice.rest, 1);
    double begin = 0;
    for (std::uint32_t k = 0; k < choice.index; ++k) begin += distribution.probability(k);
    ASSERT_NEAR(begin + choice.rest * choice.probability, number, 1e-12);
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    EXPECT_NEAR(counts[i], weights[i] / distribution.total() * kNumbers, 1.5) << i;
    EXPECT_NEAR(distribution.probability(static_cast<std::uint32_t>(i)), weights[i] / distribution.total(), 1e-15);
  }
}

TEST(TableSampling, ZeroWeightsAndTheEnds) {
  EXPECT_TRUE(DiscreteDistribution().empty());
  EXPECT_TRUE(DiscreteDistribution(std::vector<double>{}).empty());
  EXPECT_TRUE(DiscreteDistribution(std::vector<double>{0, -1, 0}).empty());
  EXPECT_TRUE(GridDistribution().empty());
  EXPECT_TRUE(GridDistribution(std::vector<GridDistribution::Cell>{{3, 4, 0}}).empty());
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> weights(1 + random() % 40);
    for (double& weight : weights)
      weight = random() % 3 == 0 ? 0.0 : std::ldexp(1.0, static_cast<int>(random() % 80) - 60);
    weights[random() % weights.size()] = 1;
    const DiscreteDistribution distribution(weights);
    for (const double number : {0.0, 0x1p-60, 1 - 0x1p-24, 1 - 0x1p-53, std::ldexp(random() % 4096, -12)})
      ASSERT_GT(weights[distribution.choose(number).index], 0) << number;
  }
}

TEST(TableSampling, GridChoosesRowsAndColumns) {
  const std::vector<GridDistribution::Cell> cells{{2, 5, 1}, {2, 9, 3}, {4, 0, 0}, {7, 1, 4}};
  const GridDistribution grid(cells);
  EXPECT_EQ(grid.total(), 8);
  const auto choice = grid.choose(0.25, 0.5);
  EXPECT_EQ(choice.row, 2U);
  EXPECT_EQ(choice.column, 9U);
  EXPECT_DOUBLE_EQ(choice.probability, 3.0 / 8);
  EXPECT_DOUBLE_EQ(choice.rest_row, 0.5);
  EXPECT_NEAR(choice.rest_column, 1.0 / 3, 1e-15);
  EXPECT_EQ(grid.choose(0.5, 0.999).row, 7U);
}

TEST(TableSampling, LinearDensities) {
  for (const auto& [a, b] : {std::pair{1.0, 1.0}, {0.0, 2.0}, {5.0, 0.0}, {1.0, 3.0}})
    for (const double number : {0.0, 0.1, 0.5, 0.9}) {
      const double x = sample_linear(a, b, number);
      EXPECT_NEAR((a * x + (b - a) * x * x / 2) / ((a + b) / 2), number, 1e-12) << "share below " << x;
    }
}

}  // namespace
}  // namespace relook
