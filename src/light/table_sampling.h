// Choosing by weights: one of n, a cell of a grid, a place within a cell. Prefix sums in doubles and a table of where
// to begin to look, so a choice costs a few steps whatever n is, and growing numbers choose growing indices: points
// that are stratified stay so. Pure functions of weights and numbers: the same bits on every machine.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"

namespace relook {

/// One of n, by weights. What weighs nothing is never chosen.
class DiscreteDistribution {
 public:
  struct Choice {
    std::uint32_t index = 0;
    double probability = 0;
    double rest = 0;  // the number's place within the part of [0, 1) that chooses `index`: [0, 1) again
  };

  DiscreteDistribution() = default;
  /// Requires finite weights, fewer than 2^32; those below 0 count as 0.
  explicit DiscreteDistribution(std::span<const double> weights);

  /// Whether there is nothing to choose.
  [[nodiscard]] bool empty() const { return !(total() > 0); }
  [[nodiscard]] double total() const { return ends_.empty() ? 0.0 : ends_.back(); }
  /// `number` in [0, 1). Requires !empty().
  [[nodiscard]] Choice choose(double number) const;
  [[nodiscard]] double probability(std::uint32_t index) const;

 private:
  std::vector<double> ends_;           // [n], sums of the weights up to and with each
  std::vector<std::uint32_t> starts_;  // [n + 1], by n * number rounded down: no index before it is chosen
};

/// A cell of a grid, by weights: first its row, then its column. Rows and columns without weight take no memory.
class GridDistribution {
 public:
  struct Cell {
    std::uint32_t row = 0, column = 0;
    double weight = 0;
    std::array<float, 4> corners{};  // what else is to be known of a cell once it is chosen
  };
  struct Choice {
    std::uint32_t row = 0, column = 0;
    double probability = 0;
    double rest_row = 0, rest_column = 0;  // what is left of the numbers: [0, 1)
    std::array<float, 4> corners{};
  };

  GridDistribution() = default;
  /// `cells`: by row, then by column, each at most once; finite weights, those of 0 and below are left out.
  explicit GridDistribution(std::span<const Cell> cells);

  [[nodiscard]] bool empty() const { return rows_.empty(); }
  [[nodiscard]] double total() const { return rows_.total(); }
  /// Numbers in [0, 1). Requires !empty().
  [[nodiscard]] Choice choose(double number_row, double number_column) const;

  /// The same in three steps, each of which asks for the memory that the next one reads: several choices side by side
  /// wait for it together.
  struct Search {
    DiscreteDistribution::Choice row;
    double number = 0;           // for the column
    std::size_t start = 0;       // into `starts_`
    std::size_t low = 0, high = 0;  // parts of the row, after narrow()
  };
  [[nodiscard]] Search search(double number_row, double number_column) const;
  void narrow(Search& search) const;
  [[nodiscard]] Choice found(const Search& search) const;

 private:
  /// A cell that may be chosen, all that a choice reads of it in one place: tables are larger than a processor's caches.
  struct Part {
    double end = 0;  // sum of the weights of its row up to and with it
    std::uint32_t column = 0;
    std::array<float, 4> corners{};
  };
  struct Row {
    std::uint32_t row = 0;
    std::size_t first = 0, size = 0;  // of its parts
  };
  std::vector<Row> row_tables_;
  std::vector<Part> parts_;            // row by row
  std::vector<std::uint32_t> starts_;  // of each row, as DiscreteDistribution's: one more than its parts
  DiscreteDistribution rows_;          // over `row_tables_`
};

/// The place in [0, 1] whose density is a (1 - x) + b x over its mean. Requires a, b >= 0; 0 where
/// both are.
[[nodiscard]] double sample_linear(double a, double b, double number);

}  // namespace relook
