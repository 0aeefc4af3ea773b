// Columns that are kept: each once, one value where all lanes share it. Part of compressed colour trees.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "color/expression/lanes.h"

namespace relook {

class StoredColumns {
 public:
  StoredColumns() = default;
  /// Columns of zeros, to be filled and then packed.
  StoredColumns(std::size_t count, std::size_t lanes)
      : lanes_(lanes), columns_(count), values_(count * length()) {
    for (std::size_t k = 0; k < count; ++k) columns_[k].first = static_cast<std::uint32_t>(k * length());
  }

  [[nodiscard]] std::size_t size() const { return columns_.size(); }
  /// The values of a column; null: all lanes share one.
  [[nodiscard]] const float* values(std::size_t column) const {
    const Stored& stored = columns_[column];
    return stored.first == kShared ? nullptr : values_[stored.first].lanes.data();
  }
  [[nodiscard]] float* values(std::size_t column) { return values_[columns_[column].first].lanes.data(); }
  [[nodiscard]] float shared(std::size_t column) const { return columns_[column].shared; }

  /// Makes a register the column from lane `first` on. Asks for the values of the next block already: there are more
  /// columns than a processor's prefetcher follows.
  void load(std::size_t column, std::uint32_t reg, std::size_t first, std::size_t lanes, Scratch& scratch) const {
    const Stored& stored = columns_[column];
    if (stored.first == kShared) {
      std::fill_n(scratch.own(reg), whole_vectors(lanes), stored.shared);
      return;
    }
    constexpr std::size_t kVectors = kLanes / kVectorLanes;
    const Vector* from = values_.data() + stored.first + first / kVectorLanes;
    for (std::size_t k = kVectors; k < 2 * kVectors; ++k) __builtin_prefetch(from + k);
    scratch.at[reg] = from->lanes.data();
  }

  /// Drops columns that hold one value, or the values of an earlier column.
  void pack();
  [[nodiscard]] std::size_t bytes() const { return columns_.size() * sizeof(Stored) + values_.size() * sizeof(Vector); }

 private:
  struct Stored {
    std::uint32_t first = kShared;  // index of its first vector in `values_`
    float shared = 0;               // the one value that all its lanes share
  };
  static constexpr std::uint32_t kShared = 0xFFFFFFFFU;
  struct alignas(64) Vector {
    std::array<float, kVectorLanes> lanes;
  };
  [[nodiscard]] std::size_t length() const { return whole_vectors(lanes_) / kVectorLanes; }

  std::size_t lanes_ = 0;
  std::vector<Stored> columns_;
  std::vector<Vector> values_;  // one column after the other, rounded up to whole vectors
};

/// Runs a kernel over `lanes` lanes of `source` and keeps its outputs, packed.
template <class Source>
[[nodiscard]] StoredColumns stored_columns(const Kernel& constants, const Parameters& parameters, const Source& source,
                                           std::size_t lanes, Scratch& scratch) {
  StoredColumns columns(constants.outputs.size(), lanes);
  if (columns.size() == 0) return columns;
  KernelRun run(constants, parameters, source, lanes, scratch);
  for (std::size_t first = 0; first < lanes; first += kLanes) {
    const std::size_t some = std::min(kLanes, lanes - first);
    run.run(first, some);
    for (std::size_t k = 0; k < columns.size(); ++k) std::copy_n(run.output(k), some, columns.values(k) + first);
  }
  columns.pack();
  return columns;
}

}  // namespace relook
