// Packed sums hold what unpacked ones do, in no more bytes than they need; pixels follow from either.
#include "light/sums/packed_sums.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "frame/light_sums.h"

namespace relook {
namespace {

/// A tile with one sum, of which one channel of one pixel has a value.
TileSums with_value(Uint128 steps) {
  TileSums sums(1, 5);
  // Terms of powers of two make up any value.
  for (int bit = 0; bit < 127; ++bit)
    if ((steps >> bit & 1U) != 0) {
      const int power = std::min(bit + kFixedStep, 30);
      const int times = 1 << (bit + kFixedStep - power);
      for (int i = 0; i < times; ++i) sums.add(0, 2, Color(0, std::ldexp(1.0F, power), 0));
    }
  return sums;
}

void expect_round_trip(const TileSums& sums) {
  const PackedSums packed = PackedSums::pack(sums);
  EXPECT_EQ(packed.unpack(), sums);
  EXPECT_EQ(PackedSums::from_bytes(packed.to_bytes()), packed);
  for (std::size_t sum = 0; sum < sums.sums(); ++sum) {
    EXPECT_EQ(packed.is_zero(sum), sums.is_zero(sum));
    for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel)
      EXPECT_EQ(packed.value(sum, pixel), sums.value(sum, pixel));
  }
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel) EXPECT_EQ(packed.coverage(pixel), sums.coverage(pixel));
  std::vector<double> values(sums.pixels());
  for (std::size_t sum = 0; sum < sums.sums(); ++sum)
    for (std::size_t channel = 0; channel < 3; ++channel) {
      packed.channel_values(sum, channel, values);
      for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel)
        EXPECT_EQ(values[pixel], sums.value(sum, pixel)[channel]);
    }
  packed.coverage_values(values);
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel) EXPECT_EQ(values[pixel], sums.coverage(pixel));
}

TileSums some_sums() {
  TileSums sums(3, 6);
  sums.add(0, 1, Color(0.1F, 2, 3e-6F));
  sums.add(0, 5, Color(7, -0.25F, 9));
  sums.add(2, 0, Color(1e-12F, 0, 1e6F));
  for (std::size_t pixel = 0; pixel < 6; ++pixel) sums.add_coverage(pixel, 1);
  return sums;
}

std::string fault_of(const std::vector<SumShape>& shapes, std::size_t pixels, BytesView values) {
  try {
    static_cast<void>(PackedSums::of_parts(shapes, pixels, values));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(PackedSums, hold_values_of_all_widths) {
  for (int bit = 0; bit <= 126; ++bit) {
    const Uint128 power = Uint128{1} << bit;
    if (bit > 122) continue;  // as many terms as that would take
    expect_round_trip(with_value(power));
    expect_round_trip(with_value(power - 1));
    TileSums below = with_value(power - 1);
    TileSums zero = with_value(0);
    for (int i = 0; i < 2; ++i) zero.subtract(0, 1, Color(std::ldexp(1.0F, std::min(bit + kFixedStep, 30)), 0, 0));
    below.add(zero);
    expect_round_trip(below);
  }
}

TEST(PackedSums, round_values_of_all_widths_once) {
  std::mt19937_64 random(11);
  for (int bits = 1; bits <= 126; ++bits)
    for (int repetition = 0; repetition < 20; ++repetition) {
      // Halfway between two doubles, or next to that, or anything, of either sign.
      Uint128 steps = (Uint128{random()} << 64 | random()) >> (128 - bits) | Uint128{1} << (bits - 1);
      const int kept = bits - 53;
      if (kept > 0 && repetition % 4 != 0) {
        steps = (steps >> kept << kept) + (Uint128{1} << (kept - 1));
        if (repetition % 4 == 2) ++steps;
        if (repetition % 4 == 3) --steps;
      }
      const auto shape = [&] {
        const auto width = static_cast<std::uint8_t>(bits / 8 + 1);
        return std::vector<SumShape>{{0, width, 0}, {0, 0, 0}};
      }();
      const std::size_t width = shape[0].width;
      const Uint128 values[] = {steps, -steps, Uint128{1}};  // the last one: no byte is left out
      Bytes bytes;
      for (const Uint128 value : values) {
        const BytesView all = std::as_bytes(std::span(&value, 1));
        bytes.insert(bytes.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(width));
      }
      const PackedSums packed = PackedSums::of_parts(shape, 1, bytes);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        std::vector<double> value(1);
        packed.channel_values(0, channel, value);
        EXPECT_EQ(value[0], value_of({values[channel]})) << bits << " bits";
      }
    }
}

TEST(PackedSums, take_no_more_bytes_than_they_need) {
  const auto shape = [](const TileSums& sums) { return PackedSums::pack(sums).shapes()[0]; };
  EXPECT_EQ(shape(TileSums(1, 5)), (SumShape{0, 0, 0}));
  EXPECT_EQ(PackedSums::pack(TileSums(1, 5)).values().size(), 0U);
  EXPECT_EQ(shape(with_value(1)), (SumShape{0, 1, 0}));
  EXPECT_EQ(shape(with_value(0x7F)), (SumShape{0, 1, 0}));
  EXPECT_EQ(shape(with_value(0x80)), (SumShape{0, 2, 0}));
  EXPECT_EQ(shape(with_value(0x7F00)), (SumShape{1, 1, 0}));
  EXPECT_EQ(shape(with_value(Uint128{1} << 80)), (SumShape{10, 1, 0}));
  TileSums negative(1, 5);
  negative.add(0, 0, Color(-0x1p-80F, 0, 0));
  EXPECT_EQ(shape(negative), (SumShape{0, 1, 0}));
  negative.add(0, 0, Color(0x1p-80F, -0x1p-73F, 0));
  EXPECT_EQ(shape(negative), (SumShape{0, 1, 0}));  // -128
  expect_round_trip(negative);
  negative.add(0, 0, Color(0, -0x1p-80F, 0));
  EXPECT_EQ(shape(negative), (SumShape{0, 2, 0}));
  expect_round_trip(negative);
}

TEST(PackedSums, hold_sums_that_wrapped) {
  TileSums sums(1, 1);
  for (int i = 0; i < (1 << 17); ++i) sums.add(0, 0, Color(0x1p30F, -0x1p30F, 1));
  expect_round_trip(sums);
  for (int i = 0; i < (1 << 17); ++i) sums.subtract(0, 0, Color(0x1p30F, -0x1p30F, 1));
  EXPECT_TRUE(sums.is_zero(0));
}

TEST(PackedSums, keep_what_was_clamped) {
  TileSums sums = some_sums();
  sums.add(1, 2, Color(std::numeric_limits<float>::quiet_NaN(), 1e30F, 0));
  sums.subtract(1, 2, Color(0, 0x1p30F, 0));  // nothing but the count is left
  expect_round_trip(sums);
  EXPECT_EQ(PackedSums::pack(sums).clamped(), 2U);
}

TEST(PackedSums, of_no_tile_are_empty) {
  EXPECT_TRUE(PackedSums().empty());
  EXPECT_EQ(PackedSums().unpack(), TileSums());
  EXPECT_EQ(PackedSums::pack(TileSums()), PackedSums());
  EXPECT_FALSE(PackedSums::pack(TileSums(0, 4)).empty());
  EXPECT_TRUE(PackedSums().remapped({}).empty());
  expect_round_trip(TileSums(0, 4));
}

TEST(PackedSums, refuse_what_pack_does_not_make) {
  const PackedSums packed = PackedSums::pack(some_sums());
  const std::vector<SumShape> shapes(packed.shapes().begin(), packed.shapes().end());
  EXPECT_EQ(fault_of(shapes, 6, packed.values()), "");
  EXPECT_NE(fault_of(shapes, 7, packed.values()), "");
  EXPECT_NE(fault_of({}, 6, {}), "");
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (const int change : {-1, 1, 16, 255}) {
      std::vector<SumShape> other = shapes;
      other[i].width = static_cast<std::uint8_t>(other[i].width + change);
      EXPECT_NE(fault_of(other, 6, packed.values()), "") << i;
      other = shapes;
      other[i].dropped = static_cast<std::uint8_t>(other[i].dropped + 16);
      EXPECT_NE(fault_of(other, 6, packed.values()), "") << i;
    }
  const Bytes zeros(12);
  EXPECT_EQ(fault_of({{0, 2, 0}}, 6, zeros), "sums of light that are wider than they need to be");
  const Bytes bytes = packed.to_bytes();
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(static_cast<void>(PackedSums::from_bytes(BytesView(bytes).first(length))), InputError) << length;
  for (std::size_t byte = 0; byte < 2 * sizeof(std::uint64_t); ++byte) {
    Bytes other = bytes;
    other[byte] ^= std::byte{0x10};
    EXPECT_THROW(static_cast<void>(PackedSums::from_bytes(other)), InputError) << byte;
  }
}

TEST(LightSums, layers_add_up_to_the_pixel) {
  const TileSums sums = some_sums();
  const PackedSums packed = PackedSums::pack(sums);
  const std::array<LightColor, 3> colors{LightColor{1, 0.1, 1e-3}, LightColor{5, 5, 5}, LightColor{1.0 / 3, 7, 2}};
  constexpr std::uint32_t kSamples = 7;
  for (std::size_t pixel = 0; pixel < 6; ++pixel) {
    const Rgba color = compose(sums, pixel, colors, kSamples);
    Rgba sum(0, 0, 0, static_cast<float>(1.0 / kSamples));
    for (std::size_t i = 0; i < colors.size(); ++i) {
      const Color of_light = layer(packed, i, pixel, colors[i], kSamples);
      // Rounded to a double after the sum, the product and the quotient; to a float once, at the end.
      EXPECT_EQ(of_light.x, static_cast<float>(colors[i][0] * sums.value(i, pixel)[0] / 7.0));
      sum.r += of_light.x;
      sum.g += of_light.y;
      sum.b += of_light.z;
    }
    EXPECT_EQ(color, sum) << pixel;
    EXPECT_EQ(compose(packed, pixel, colors, kSamples), sum) << pixel;
  }
}

TEST(LightSums, pixels_without_light_are_positive_zeros) {
  TileSums sums(2, 1);
  sums.add(0, 0, Color(-1, 1, 1));
  sums.subtract(0, 0, Color(-1, 1, 0));
  const std::array<LightColor, 2> colors{LightColor{-1, -1, 0}, LightColor{-3, 0, 0}};
  const Rgba color = compose(sums, 0, colors, 4);
  for (const float zero : {color.r, color.g, color.b, color.a})
    EXPECT_EQ(std::bit_cast<std::uint32_t>(zero), 0U);
}

}  // namespace
}  // namespace relook
