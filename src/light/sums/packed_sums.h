// The sums of light of one tile (light/sums/tile_sums.h) in as few bytes as they need: what is kept in memory between
// changes, and on disk. All values of a sum are stored in the same number of bytes, without the low zero bytes that
// they have in common; a sum without light takes none. Equal sums have equal bytes.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/files.h"
#include "light/sums/tile_sums.h"

namespace relook {

/// How one sum is packed.
struct SumShape {
  std::uint8_t dropped = 0;   // low bytes of every value that are left out, all zero
  std::uint8_t width = 0;     // bytes of every value, two's complement; 0: all values are zero
  std::uint64_t clamped = 0;  // channels of terms
  bool operator==(const SumShape&) const = default;
};

class PackedSums {
 public:
  PackedSums() = default;
  [[nodiscard]] static PackedSums pack(const TileSums& sums);
  /// `shapes`: one a sum and that of the coverage. `values`: as values(). Throws InputError, without a file, unless
  /// they are those of a tile of so many pixels as pack() makes them.
  [[nodiscard]] static PackedSums of_parts(std::vector<SumShape> shapes, std::size_t pixels, BytesView values);
  /// Reads to_bytes(). Throws as of_parts().
  [[nodiscard]] static PackedSums from_bytes(BytesView bytes);

  [[nodiscard]] TileSums unpack() const;
  /// As TileSums::remapped().
  [[nodiscard]] PackedSums remapped(std::span<const std::uint32_t> old_of_new) const;

  /// Is there no tile, as after the default constructor or while the sums are elsewhere?
  [[nodiscard]] bool empty() const { return shapes_.empty(); }
  [[nodiscard]] std::size_t sums() const { return shapes_.empty() ? 0 : shapes_.size() - 1; }
  [[nodiscard]] std::size_t pixels() const { return pixels_; }
  [[nodiscard]] bool is_zero(std::size_t sum) const { return shapes_[sum].width == 0; }
  [[nodiscard]] std::uint64_t clamped() const;
  /// Requires: sum < sums(), pixel < pixels().
  [[nodiscard]] std::array<double, 3> value(std::size_t sum, std::size_t pixel) const {
    const SumShape shape = shapes_[sum];
    if (shape.width == 0) return {0, 0, 0};
    const std::byte* const first = values_.data() + starts_[sum] + pixel * kChannels * shape.width;
    return {value_of(read(first, shape)), value_of(read(first + shape.width, shape)),
            value_of(read(first + std::size_t{2} * shape.width, shape))};
  }
  [[nodiscard]] double coverage(std::size_t pixel) const {
    const SumShape shape = shapes_.back();
    return shape.width == 0 ? 0 : value_of(read(values_.data() + starts_.back() + pixel * shape.width, shape));
  }

  /// One channel of a sum at all pixels, of three, as value() has it, in less time. `values`: [pixels()].
  void channel_values(std::size_t sum, std::size_t channel, std::span<double> values) const;
  /// The same of the coverage.
  void coverage_values(std::span<double> values) const;

  /// One a sum, then that of the coverage.
  [[nodiscard]] std::span<const SumShape> shapes() const { return shapes_; }
  /// Value by value, little-endian: pixel by pixel its three channels, sum by sum, then the coverage.
  [[nodiscard]] BytesView values() const { return BytesView(values_).first(values_.size() - padding()); }
  /// Numbers of sums and pixels, shapes, values. Requires: not empty().
  [[nodiscard]] Bytes to_bytes() const;
  /// Memory that it takes.
  [[nodiscard]] std::size_t bytes() const;
  bool operator==(const PackedSums&) const = default;

 private:
  static constexpr std::size_t kChannels = 3, kPadding = sizeof(Uint128);

  /// Sets starts_, and makes room for the values.
  void lay_out();
  /// Of a sum or the coverage: values from the `first` on, each the one `step` after the one before.
  void read_values(std::size_t row, std::size_t first, std::size_t step, std::span<double> values) const;
  /// How many values a sum, or the coverage, has.
  [[nodiscard]] std::size_t count_of(std::size_t row) const { return pixels_ * (row < sums() ? kChannels : 1); }
  [[nodiscard]] std::size_t padding() const { return values_.empty() ? 0 : kPadding; }
  /// A value that begins at `place`. Reads 16 bytes there.
  [[nodiscard]] static Fixed read(const std::byte* place, SumShape shape) {
    Uint128 bits = 0;
    std::memcpy(&bits, place, sizeof bits);
    const int above = 128 - 8 * shape.width;
    return {static_cast<Uint128>(static_cast<Int128>(bits << above) >> above) << (8 * shape.dropped)};
  }

  std::size_t pixels_ = 0;
  std::vector<SumShape> shapes_;
  std::vector<std::size_t> starts_;  // of each, in values_
  Bytes values_;                     // with kPadding zero bytes behind them, if there are any
};

}  // namespace relook
