#include "light/table_sampling.h"

#include <algorithm>
#include <cmath>

namespace relook {
namespace {

constexpr double kBelowOne = 1.0 - 0x1p-53;

/// Appends for each n-th of [0, 1), and for 1, the first of n indices that its numbers may choose. `end(i)`: sum of the
/// weights up to and with i.
template <class End>
void append_starts(std::size_t n, const End& end, std::vector<std::uint32_t>& starts) {
  std::uint32_t index = 0;
  for (std::size_t part = 0; part <= n; ++part) {
    const double place = static_cast<double>(part) / static_cast<double>(n) * end(n - 1);
    while (index + 1 < n && end(index) <= place) ++index;
    starts.push_back(index);
  }
}

/// The n-th of [0, 1) in which a number lies.
std::size_t part_of(double number, std::size_t n) {
  return std::min(static_cast<std::size_t>(number * static_cast<double>(n)), n - 1);
}

/// `low`, `high`: the starts of the number's part and of the next one.
template <class End>
DiscreteDistribution::Choice chosen(double number, std::size_t n, const End& end, std::size_t low, std::size_t high) {
  const double total = end(n - 1), place = number * total;
  // The part may be a neighbour's by rounding, and an end may be as far as the last weight.
  while (low > 0 && end(low - 1) > place) --low;
  while (high + 1 < n && end(high) <= place) ++high;
  // The first whose end lies behind the place, or `high`.
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (end(middle) > place)
      high = middle;
    else
      low = middle + 1;
  }
  std::size_t index = low;
  while (index > 0 && !(end(index) > end(index - 1))) --index;  // numbers of 1 and above: the last with a weight
  const double begin = index == 0 ? 0.0 : end(index - 1), width = end(index) - begin;
  return {static_cast<std::uint32_t>(index), width / total, std::clamp((place - begin) / width, 0.0, kBelowOne)};
}

}  // namespace

DiscreteDistribution::DiscreteDistribution(std::span<const double> weights) {
  ends_.reserve(weights.size());
  double sum = 0;
  for (const double weight : weights) ends_.push_back(sum += std::max(weight, 0.0));
  if (empty()) return;
  starts_.reserve(ends_.size() + 1);
  append_starts(ends_.size(), [this](std::size_t i) { return ends_[i]; }, starts_);
}

DiscreteDistribution::Choice DiscreteDistribution::choose(double number) const {
  const std::uint32_t* start = &starts_[part_of(number, ends_.size())];
  return chosen(number, ends_.size(), [this](std::size_t i) { return ends_[i]; }, start[0], start[1]);
}

double DiscreteDistribution::probability(std::uint32_t index) const {
  return (ends_[index] - (index == 0 ? 0.0 : ends_[index - 1])) / total();
}

GridDistribution::GridDistribution(std::span<const Cell> cells) {
  std::vector<double> totals;
  for (std::size_t i = 0; i < cells.size();) {
    Row row{cells[i].row, parts_.size(), 0};
    double sum = 0;
    for (; i < cells.size() && cells[i].row == row.row; ++i)
      if (cells[i].weight > 0) parts_.push_back({sum += cells[i].weight, cells[i].column, cells[i].corners});
    row.size = parts_.size() - row.first;
    if (row.size == 0) continue;
    append_starts(row.size, [&](std::size_t k) { return parts_[row.first + k].end; }, starts_);
    totals.push_back(sum);
    row_tables_.push_back(row);
  }
  rows_ = DiscreteDistribution(totals);
}

GridDistribution::Search GridDistribution::search(double number_row, double number_column) const {
  const DiscreteDistribution::Choice row = rows_.choose(number_row);
  const Row& table = row_tables_[row.index];
  const std::size_t start = table.first + row.index + part_of(number_column, table.size);
  __builtin_prefetch(&starts_[start]);
  return {row, number_column, start, 0, 0};
}

void GridDistribution::narrow(Search& search) const {
  const Part* parts = &parts_[row_tables_[search.row.index].first];
  search.low = starts_[search.start];
  search.high = starts_[search.start + 1];
  __builtin_prefetch(parts + search.low);
  __builtin_prefetch(parts + search.high);
}

GridDistribution::Choice GridDistribution::found(const Search& search) const {
  const Row& table = row_tables_[search.row.index];
  const Part* parts = &parts_[table.first];
  const DiscreteDistribution::Choice column = chosen(
      search.number, table.size, [parts](std::size_t k) { return parts[k].end; }, search.low, search.high);
  const Part& part = parts[column.index];
  return {table.row,       part.column,  search.row.probability * column.probability,
          search.row.rest, column.rest, part.corners};
}

GridDistribution::Choice GridDistribution::choose(double number_row, double number_column) const {
  Search one = search(number_row, number_column);
  narrow(one);
  return found(one);
}

double sample_linear(double a, double b, double number) {
  const double below = a + std::sqrt(a * a + (b * b - a * a) * number);
  return below > 0 ? std::clamp(number * (a + b) / below, 0.0, kBelowOne) : 0.0;
}

}  // namespace relook
