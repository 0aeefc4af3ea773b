// The sums of light of one tile while terms come and go: every sum has three channels a pixel, and beside the sums
// stands the coverage. All is exact (light/sums/fixed.h), so terms may come in any order, and what was added and is
// subtracted again leaves no trace. A sum that no light has reached takes no memory.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "base/math.h"
#include "light/sums/fixed.h"

namespace relook {

/// In a list of sums by what they were before: there was none.
inline constexpr std::uint32_t kNewSum = 0xFFFFFFFF;

class TileSums {
 public:
  TileSums() = default;
  /// All zero.
  TileSums(std::size_t sums, std::size_t pixels) : pixels_(pixels), rows_(sums + 1) {}

  [[nodiscard]] std::size_t sums() const { return rows_.empty() ? 0 : rows_.size() - 1; }
  [[nodiscard]] std::size_t pixels() const { return pixels_; }

  /// Requires, as below: sum < sums(), pixel < pixels(). The channels of a term are clamped one by one and counted.
  void add(std::size_t sum, std::size_t pixel, const Color& term) {
    Row& row = rows_[sum];
    if (row.values.empty() && !make_room(row, kChannels, term)) return;
    Fixed* const place = &row.values[pixel * kChannels];
    place[0] += fixed_of(term.x, row.clamped);
    place[1] += fixed_of(term.y, row.clamped);
    place[2] += fixed_of(term.z, row.clamped);
  }
  /// Takes back what was added, here or in the sums that are subtracted from.
  void subtract(std::size_t sum, std::size_t pixel, const Color& term) {
    Row& row = rows_[sum];
    if (row.values.empty() && !make_room(row, kChannels, term)) return;
    Fixed* const place = &row.values[pixel * kChannels];
    std::uint64_t clamped = 0;
    place[0] -= fixed_of(term.x, clamped);
    place[1] -= fixed_of(term.y, clamped);
    place[2] -= fixed_of(term.z, clamped);
    row.clamped -= clamped;
  }
  void add_coverage(std::size_t pixel, float coverage);
  void subtract_coverage(std::size_t pixel, float coverage);
  /// Adds all sums of another tile of the same shape: of other samples of its pixels, or of what changed in them.
  void add(const TileSums& other);
  /// Makes a sum zero at all pixels.
  void clear(std::size_t sum) { rows_[sum] = {}; }

  /// At all pixels?
  [[nodiscard]] bool is_zero(std::size_t sum) const;
  /// In units of the terms, each rounded once.
  [[nodiscard]] std::array<double, 3> value(std::size_t sum, std::size_t pixel) const;
  [[nodiscard]] double coverage(std::size_t pixel) const;
  /// Channels of terms that were clamped, of those that are in the sums.
  [[nodiscard]] std::uint64_t clamped() const;

  /// The same sums in another order: sum i is what sum `old_of_new[i]` was, or zero for kNewSum. What no entry names is
  /// dropped.
  [[nodiscard]] TileSums remapped(std::span<const std::uint32_t> old_of_new) const;

  /// Bytes of all sums that take memory.
  [[nodiscard]] std::size_t bytes() const;
  /// Equal values and numbers of clamped terms.
  bool operator==(const TileSums& other) const;

 private:
  friend class PackedSums;

  static constexpr std::size_t kChannels = 3;
  struct Row {
    std::vector<Fixed> values;  // [pixels_ * 3], of the coverage [pixels_]; empty: all are zero
    std::uint64_t clamped = 0;
  };

  /// False: a term of zero needs none.
  bool make_room(Row& row, std::size_t channels, const Color& term) const;
  [[nodiscard]] Row& coverage_row() { return rows_.back(); }

  std::size_t pixels_ = 0;
  std::vector<Row> rows_;  // one a sum, then that of the coverage; none: of no tile
};

}  // namespace relook
