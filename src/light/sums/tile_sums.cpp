#include "light/sums/tile_sums.h"

#include <algorithm>

#include "base/error.h"

namespace relook {
namespace {

bool is_all_zero(const std::vector<Fixed>& values) {
  return std::ranges::all_of(values, [](Fixed value) { return value == Fixed(); });
}

}  // namespace

bool TileSums::make_room(Row& row, std::size_t channels, const Color& term) const {
  if (term.x == 0 && term.y == 0 && term.z == 0) return false;
  row.values.resize(pixels_ * channels);
  return true;
}

void TileSums::add_coverage(std::size_t pixel, float coverage) {
  Row& row = coverage_row();
  if (row.values.empty() && !make_room(row, 1, Color(coverage))) return;
  row.values[pixel] += fixed_of(coverage, row.clamped);
}

void TileSums::subtract_coverage(std::size_t pixel, float coverage) {
  Row& row = coverage_row();
  if (row.values.empty() && !make_room(row, 1, Color(coverage))) return;
  std::uint64_t clamped = 0;
  row.values[pixel] -= fixed_of(coverage, clamped);
  row.clamped -= clamped;
}

void TileSums::add(const TileSums& other) {
  require(other.pixels_ == pixels_ && other.rows_.size() == rows_.size(), "sums of one shape are added");
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    const Row& more = other.rows_[i];
    row.clamped += more.clamped;
    if (row.values.empty())
      row.values = more.values;
    else
      for (std::size_t k = 0; k < more.values.size(); ++k) row.values[k] += more.values[k];
  }
}

bool TileSums::is_zero(std::size_t sum) const { return is_all_zero(rows_[sum].values); }

std::array<double, 3> TileSums::value(std::size_t sum, std::size_t pixel) const {
  const std::vector<Fixed>& values = rows_[sum].values;
  if (values.empty()) return {0, 0, 0};
  const Fixed* const place = &values[pixel * kChannels];
  return {value_of(place[0]), value_of(place[1]), value_of(place[2])};
}

double TileSums::coverage(std::size_t pixel) const {
  const std::vector<Fixed>& values = rows_.back().values;
  return values.empty() ? 0 : value_of(values[pixel]);
}

std::uint64_t TileSums::clamped() const {
  std::uint64_t clamped = 0;
  for (const Row& row : rows_) clamped += row.clamped;
  return clamped;
}

TileSums TileSums::remapped(std::span<const std::uint32_t> old_of_new) const {
  TileSums next(old_of_new.size(), pixels_);
  for (std::size_t i = 0; i < old_of_new.size(); ++i)
    if (old_of_new[i] != kNewSum) next.rows_[i] = rows_[old_of_new[i]];
  next.rows_.back() = rows_.back();
  return next;
}

std::size_t TileSums::bytes() const {
  std::size_t bytes = rows_.capacity() * sizeof(Row);
  for (const Row& row : rows_) bytes += row.values.capacity() * sizeof(Fixed);
  return bytes;
}

bool TileSums::operator==(const TileSums& other) const {
  if (pixels_ != other.pixels_ || rows_.size() != other.rows_.size()) return false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row &mine = rows_[i], &others = other.rows_[i];
    if (mine.clamped != others.clamped) return false;
    const bool is_equal = mine.values.empty() || others.values.empty()
                              ? is_all_zero(mine.values) && is_all_zero(others.values)
                              : mine.values == others.values;
    if (!is_equal) return false;
  }
  return true;
}

}  // namespace relook
