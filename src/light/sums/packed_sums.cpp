#include "light/sums/packed_sums.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/tiles.h"
#include "base/vector_clones.h"

namespace relook {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::size_t kShapeBytes = 2 + sizeof(std::uint64_t);  // of to_bytes()

[[noreturn]] void refuse(const char* what) { throw InputError("", "", what); }

int trailing_zeros(Uint128 bits) {
  const auto low = static_cast<std::uint64_t>(bits);
  return low != 0 ? std::countr_zero(low) : 64 + std::countr_zero(static_cast<std::uint64_t>(bits >> 64));
}

/// What the lowest bit of packed values stands for.
double unit_of(SumShape shape) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + kFixedStep + 8 * shape.dropped) << 52);
}

/// What all values of a sum have in common.
struct SumBits {
  Uint128 any = 0;     // bits that one of them has
  Uint128 unlike = 0;  // that differ in one of them from its sign

  void take(Fixed value) {
    any |= value.bits;
    unlike |= value.bits ^ static_cast<Uint128>(value.steps() >> 127);
  }
  /// The narrowest shape.
  [[nodiscard]] SumShape shape(std::uint64_t clamped) const {
    if (any == 0) return {0, 0, clamped};
    const int dropped = trailing_zeros(any) / 8;
    const int bytes = fixed_bits::bit_width(unlike) / 8 + 1;  // with a bit for the sign
    return {static_cast<std::uint8_t>(dropped), static_cast<std::uint8_t>(bytes - dropped), clamped};
  }
};

/// Values of 8 bytes at most, `step` bytes apart.
RELOOK_VECTOR_CLONES
void read_narrow(const std::byte* place, std::size_t step, SumShape shape, std::span<double> values) {
  const int above = 64 - 8 * shape.width;
  const double unit = unit_of(shape);
  for (double& value : values) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, place, sizeof bits);
    value = static_cast<double>(static_cast<std::int64_t>(bits << above) >> above) * unit;
    place += step;
  }
}

/// Values of 8 to kMiddleBytes bytes. The highest 7 are `high`, the others `low`. The nearest double to `high`, and what
/// it leaves out together with `low`, are doubles without an error (the second is less than 2^51), so that their sum is
/// rounded once.
constexpr std::size_t kMiddleBytes = 13;
RELOOK_VECTOR_CLONES
void read_middle(const std::byte* place, std::size_t step, SumShape shape, std::span<double> values) {
  constexpr int kHighBytes = 7;
  const int low_bits = 8 * (shape.width - kHighBytes);
  const std::uint64_t low_mask = (std::uint64_t{1} << low_bits) - 1;
  const std::size_t end = shape.width - sizeof(std::uint64_t);
  const double unit = unit_of(shape), high_unit = static_cast<double>(std::int64_t{1} << low_bits);
  for (double& value : values) {
    std::uint64_t low = 0, last = 0;
    std::memcpy(&low, place, sizeof low);
    std::memcpy(&last, place + end, sizeof last);
    const std::int64_t high = static_cast<std::int64_t>(last) >> 8;
    const auto rounded = static_cast<double>(high);
    const std::int64_t rest = (high - static_cast<std::int64_t>(rounded)) * (std::int64_t{1} << low_bits) +
                              static_cast<std::int64_t>(low & low_mask);
    value = (rounded * high_unit + static_cast<double>(rest)) * unit;
    place += step;
  }
}

RELOOK_VECTOR_CLONES
void read_wide(const std::byte* place, std::size_t step, SumShape shape, std::span<double> values) {
  const int above = 128 - 8 * shape.width;
  const double unit = unit_of(shape);
  for (double& value : values) {
    Uint128 bits = 0;
    std::memcpy(&bits, place, sizeof bits);
    value = nearest_double(static_cast<Int128>(bits << above) >> above) * unit;
    place += step;
  }
}

}  // namespace

PackedSums PackedSums::pack(const TileSums& sums) {
  PackedSums packed;
  packed.pixels_ = sums.pixels_;
  for (const TileSums::Row& row : sums.rows_) {
    SumBits bits;
    for (const Fixed value : row.values) bits.take(value);
    packed.shapes_.push_back(bits.shape(row.clamped));
  }
  packed.lay_out();
  for (std::size_t i = 0; i < packed.shapes_.size(); ++i) {
    const SumShape shape = packed.shapes_[i];
    if (shape.width == 0) continue;
    std::byte* place = packed.values_.data() + packed.starts_[i];
    // Each value is overwritten from its end on by the next one; the last one's excess is made zero again.
    for (const Fixed value : sums.rows_[i].values) {
      const Uint128 kept = value.bits >> (8 * shape.dropped);
      std::memcpy(place, &kept, sizeof kept);
      place += shape.width;
    }
    std::fill_n(place, kPadding, std::byte{0});
  }
  return packed;
}

void PackedSums::lay_out() {
  std::size_t end = 0;
  starts_.clear();
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    starts_.push_back(end);
    end += count_of(i) * shapes_[i].width;
  }
  values_.assign(end == 0 ? 0 : end + kPadding, std::byte{0});
}

PackedSums PackedSums::of_parts(std::vector<SumShape> shapes, std::size_t pixels, BytesView values) {
  if (shapes.empty()) refuse("sums of light without that of the coverage");
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const SumShape shape = shapes[i];
    if (shape.dropped + shape.width > static_cast<int>(sizeof(Uint128)) || (shape.width == 0 && shape.dropped != 0))
      refuse("sums of light of impossible width");
    bytes += pixels * (i + 1 < shapes.size() ? kChannels : 1) * shape.width;
  }
  if (bytes != values.size()) refuse("sums of light of another length than their widths say");
  PackedSums packed;
  packed.pixels_ = pixels;
  packed.shapes_ = std::move(shapes);
  packed.lay_out();
  std::ranges::copy(values, packed.values_.begin());
  for (std::size_t i = 0; i < packed.shapes_.size(); ++i) {
    const SumShape shape = packed.shapes_[i];
    if (shape.width == 0) continue;
    SumBits bits;
    const std::byte* place = packed.values_.data() + packed.starts_[i];
    for (std::size_t k = 0; k < packed.count_of(i); ++k, place += shape.width) bits.take(read(place, shape));
    if (bits.shape(shape.clamped) != shape) refuse("sums of light that are wider than they need to be");
  }
  return packed;
}

TileSums PackedSums::unpack() const {
  if (empty()) return {};
  TileSums sums(this->sums(), pixels_);
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const SumShape shape = shapes_[i];
    TileSums::Row& row = sums.rows_[i];
    row.clamped = shape.clamped;
    if (shape.width == 0) continue;
    row.values.resize(count_of(i));
    const std::byte* place = values_.data() + starts_[i];
    for (Fixed& value : row.values) {
      value = read(place, shape);
      place += shape.width;
    }
  }
  return sums;
}

PackedSums PackedSums::remapped(std::span<const std::uint32_t> old_of_new) const {
  PackedSums next;
  if (empty()) return next;
  next.pixels_ = pixels_;
  for (const std::uint32_t old : old_of_new) next.shapes_.push_back(old == kNewSum ? SumShape() : shapes_[old]);
  next.shapes_.push_back(shapes_.back());
  next.lay_out();
  for (std::size_t i = 0; i < next.shapes_.size(); ++i) {
    if (next.shapes_[i].width == 0) continue;
    const std::size_t old = i < old_of_new.size() ? old_of_new[i] : sums();
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(starts_[old]), next.count_of(i) * next.shapes_[i].width,
                next.values_.begin() + static_cast<std::ptrdiff_t>(next.starts_[i]));
  }
  return next;
}

void PackedSums::read_values(std::size_t row, std::size_t first, std::size_t step, std::span<double> values) const {
  require(values.size() == pixels_, "a place a pixel");
  const SumShape shape = shapes_[row];
  if (shape.width == 0) {
    std::ranges::fill(values, 0.0);
    return;
  }
  const std::byte* const place = values_.data() + starts_[row] + first * shape.width;
  if (shape.width <= sizeof(std::uint64_t))
    read_narrow(place, step * shape.width, shape, values);
  else if (shape.width <= kMiddleBytes)
    read_middle(place, step * shape.width, shape, values);
  else
    read_wide(place, step * shape.width, shape, values);
}

void PackedSums::channel_values(std::size_t sum, std::size_t channel, std::span<double> values) const {
  read_values(sum, channel, kChannels, values);
}

void PackedSums::coverage_values(std::span<double> values) const { read_values(sums(), 0, 1, values); }

std::uint64_t PackedSums::clamped() const {
  std::uint64_t clamped = 0;
  for (const SumShape& shape : shapes_) clamped += shape.clamped;
  return clamped;
}

Bytes PackedSums::to_bytes() const {
  require(!empty(), "what is packed is there");
  const std::array<std::uint64_t, 2> counts{sums(), pixels_};
  const BytesView head = std::as_bytes(std::span(counts));
  Bytes bytes(head.begin(), head.end());
  bytes.reserve(head.size() + shapes_.size() * kShapeBytes + values().size());
  for (const SumShape& shape : shapes_) {
    bytes.push_back(std::byte{shape.dropped});
    bytes.push_back(std::byte{shape.width});
    const auto clamped = std::as_bytes(std::span(&shape.clamped, 1));
    bytes.insert(bytes.end(), clamped.begin(), clamped.end());
  }
  bytes.insert(bytes.end(), values().begin(), values().end());
  return bytes;
}

PackedSums PackedSums::from_bytes(BytesView bytes) {
  std::array<std::uint64_t, 2> counts{};
  if (bytes.size() < sizeof counts) refuse("sums of light that are cut short");
  std::memcpy(counts.data(), bytes.data(), sizeof counts);
  bytes = bytes.subspan(sizeof counts);
  const auto [sums, pixels] = counts;
  if (sums >= bytes.size() / kShapeBytes) refuse("sums of light that are cut short");
  if (pixels > std::size_t{kTileSize} * kTileSize) refuse("sums of light of more pixels than a tile has");
  std::vector<SumShape> shapes(sums + 1);
  for (SumShape& shape : shapes) {
    shape.dropped = std::to_integer<std::uint8_t>(bytes[0]);
    shape.width = std::to_integer<std::uint8_t>(bytes[1]);
    std::memcpy(&shape.clamped, bytes.data() + 2, sizeof shape.clamped);
    bytes = bytes.subspan(kShapeBytes);
  }
  return of_parts(std::move(shapes), pixels, bytes);
}

std::size_t PackedSums::bytes() const {
  return values_.capacity() + shapes_.capacity() * sizeof(SumShape) + starts_.capacity() * sizeof(std::size_t);
}

}  // namespace relook
