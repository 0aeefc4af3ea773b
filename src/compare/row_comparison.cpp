#include "compare/row_comparison.h"

#include <half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace relook {
namespace {

template <class Value>
Value stored(const SampleRow& row, std::int64_t x) {
  Value value{};
  if (x >= row.x0 && x < row.x1)
    std::memcpy(&value, row.samples + static_cast<std::size_t>(x - row.x0) * sizeof value, sizeof value);
  return value;
}

float half_value(std::uint16_t bits) {
  half value;
  value.setBits(bits);
  return value;
}

float number(const SampleRow& row, std::int64_t x) {
  if (row.kind == SampleKind::half) return half_value(stored<std::uint16_t>(row, x));
  return stored<float>(row, x);
}

bool has_same_bits(const SampleRow& a, const SampleRow& b, std::int64_t x) {
  if (a.kind != b.kind) return std::bit_cast<std::uint32_t>(number(a, x)) == std::bit_cast<std::uint32_t>(number(b, x));
  if (a.kind == SampleKind::half) return stored<std::uint16_t>(a, x) == stored<std::uint16_t>(b, x);
  return stored<std::uint32_t>(a, x) == stored<std::uint32_t>(b, x);
}

bool is_same_row(const SampleRow& a, const SampleRow& b) {
  return a.x0 == b.x0 && a.x1 == b.x1 && a.kind == b.kind &&
         (a.x0 == a.x1 ||
          std::memcmp(a.samples, b.samples, static_cast<std::size_t>(a.x1 - a.x0) * sample_bytes(a.kind)) == 0);
}

}  // namespace

float SampleRow::quantity(std::int64_t x) const { return number(*this, x); }

void LayerRow::reset(std::size_t width) {
  if (has_difference || errors.size() != width) {
    errors.assign(width, kSame);
    other_ids.assign(width, 0);
  }
  has_difference = false;
}

void compare_rows(const SampleRow& a, const SampleRow& b, std::int64_t x0, bool is_id, LayerRow& row,
                  ChannelTotals& totals) {
  if (is_same_row(a, b)) return;
  for (std::size_t i = 0; i < row.errors.size(); ++i) {
    const std::int64_t x = x0 + static_cast<std::int64_t>(i);
    if (has_same_bits(a, b, x)) continue;
    row.has_difference = totals.has_difference = true;
    double error = 0;
    if (is_id) {
      row.other_ids[i] = 1;
    } else {
      error = std::abs(double{number(a, x)} - double{number(b, x)});
      if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
    }
    row.errors[i] = std::max(row.errors[i], error);
    totals.max_error = std::max(totals.max_error, error);
    totals.squares += error * error;
  }
}

}  // namespace relook
