#include "light/table_sampling.h"

#include <algorithm>
#include <cmath>

namespace relook {
namespace {

constexpr double kBelowOne = 1.0 - 0x1p-53;

}  // namespace

DiscreteDistribution::DiscreteDistribution(std::span<const double> weights) {
  ends_.reserve(weights.size());
  double sum = 0;
  for (const double weight : weights) ends_.push_back(sum += std::max(weight, 0.0));
  if (empty()) return;
  // The first index that numbers of each n-th of [0, 1) may choose.
  const auto n = static_cast<double>(ends_.size());
  starts_.reserve(ends_.size() + 1);
  std::uint32_t index = 0;
  for (std::size_t part = 0; part <= ends_.size(); ++part) {
    const double place = static_cast<double>(part) / n * sum;
    while (index + 1 < ends_.size() && ends_[index] <= place) ++index;
    starts_.push_back(index);
  }
}

DiscreteDistribution::Choice DiscreteDistribution::choose(double number) const {
  const auto part = static_cast<std::size_t>(number * static_cast<double>(ends_.size()));
  const double place = number * total();
  std::size_t low = starts_[std::min(part, ends_.size() - 1)], high = starts_[std::min(part + 1, ends_.size())];
  // The part may be a neighbour's by rounding, and an end may be as far as the last weight.
  while (low > 0 && ends_[low - 1] > place) --low;
  while (high + 1 < ends_.size() && ends_[high] <= place) ++high;
  const auto at = std::upper_bound(ends_.begin() + static_cast<std::ptrdiff_t>(low),
                                   ends_.begin() + static_cast<std::ptrdiff_t>(high), place);
  auto index = static_cast<std::size_t>(at - ends_.begin());
  while (index > 0 && !(ends_[index] > ends_[index - 1])) --index;  // numbers of 1 and above: the last with a weight
  const double begin = index == 0 ? 0.0 : ends_[index - 1], width = ends_[index] - begin;
  return {static_cast<std::uint32_t>(index), width / total(), std::clamp((place - begin) / width, 0.0, kBelowOne)};
}

double DiscreteDistribution::probability(std::uint32_t index) const {
  return (ends_[index] - (index == 0 ? 0.0 : ends_[index - 1])) / total();
}

GridDistribution::GridDistribution(std::span<const Cell> cells) {
  std::vector<double> totals, weights;
  for (std::size_t i = 0; i < cells.size();) {
    Row row{cells[i].row, {}, {}};
    weights.clear();
    for (; i < cells.size() && cells[i].row == row.row; ++i) {
      if (!(cells[i].weight > 0)) continue;
      row.columns.push_back(cells[i].column);
      weights.push_back(cells[i].weight);
    }
    if (weights.empty()) continue;
    row.distribution = DiscreteDistribution(weights);
    totals.push_back(row.distribution.total());
    row_tables_.push_back(std::move(row));
  }
  rows_ = DiscreteDistribution(totals);
}

GridDistribution::Choice GridDistribution::choose(double number_row, double number_column) const {
  const DiscreteDistribution::Choice row = rows_.choose(number_row);
  const Row& table = row_tables_[row.index];
  const DiscreteDistribution::Choice column = table.distribution.choose(number_column);
  return {table.row, table.columns[column.index], row.probability * column.probability, row.rest, column.rest};
}

double sample_linear(double a, double b, double number) {
  const double below = a + std::sqrt(a * a + (b * b - a * a) * number);
  return below > 0 ? std::clamp(number * (a + b) / below, 0.0, kBelowOne) : 0.0;
}

}  // namespace relook
