// One row of one channel of two images: which pixels have other bits, and by how much.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "frame/exr_file.h"

namespace relook {

/// Samples of the pixels [x0, x1); elsewhere 0.
struct SampleRow {
  const std::byte* samples = nullptr;
  std::int64_t x0 = 0, x1 = 0;
  SampleKind kind = SampleKind::half;
  /// Requires: a half or float channel, and x in [x0, x1).
  [[nodiscard]] float quantity(std::int64_t x) const;
};

/// A row of a layer, as far as its channels have been compared.
struct LayerRow {
  std::vector<double> errors;  // the largest of the channels; infinite when not finite, kSame for the same bits
  std::vector<char> other_ids;
  bool has_difference = false;
  static constexpr double kSame = -1;
  void reset(std::size_t width);
};

struct ChannelTotals {
  bool has_difference = false;
  double max_error = 0, squares = 0;
};

/// A half and a float are compared as floats, two of a kind bit by bit. Requires: a row of the window
/// [x0, x0 + row.errors.size()); both kinds uint, or none.
void compare_rows(const SampleRow& a, const SampleRow& b, std::int64_t x0, bool is_id, LayerRow& row,
                  ChannelTotals& totals);

}  // namespace relook
