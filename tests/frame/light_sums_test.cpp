// Sums of light are exact: held against long arithmetic in decimal steps of another kind, against themselves in other
// orders, and packed against unpacked.
#include "frame/light_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace relook {
namespace {

constexpr std::size_t kSums = 4, kPixels = 12;

/// A number of 320 bits in two's complement, lowest word first, whose lowest bit is 2^-160: no float of the tests needs
/// a lower one.
class LongNumber {
 public:
  static constexpr int kLowest = -160;

  /// Adds mantissa * 2^exponent.
  void add(std::int64_t mantissa, int exponent) {
    const bool is_negative = mantissa < 0;
    std::uint64_t rest = is_negative ? 0 - static_cast<std::uint64_t>(mantissa) : static_cast<std::uint64_t>(mantissa);
    for (int place = exponent - kLowest; rest != 0; rest >>= 1, ++place)
      if ((rest & 1U) != 0) add_bit(place, is_negative);
  }
  [[nodiscard]] bool bit(int place) const {
    return (words_[static_cast<std::size_t>(place / 32)] >> place % 32 & 1U) != 0;
  }
  [[nodiscard]] bool is_negative() const { return words_.back() >> 31 != 0; }
  /// Bits [first, first + 128).
  [[nodiscard]] Uint128 bits_from(int first) const {
    Uint128 bits = 0;
    for (int place = first + 127; place >= first; --place) bits = bits << 1 | (bit(place) ? 1U : 0U);
    return bits;
  }

 private:
  void add_bit(int place, bool is_negative) {
    auto word = static_cast<std::size_t>(place / 32);
    std::int64_t carry = (std::int64_t{1} << place % 32) * (is_negative ? -1 : 1);
    for (; carry != 0 && word < words_.size(); ++word) {
      const std::int64_t sum = static_cast<std::int64_t>(words_[word]) + carry;
      words_[word] = static_cast<std::uint32_t>(sum & 0xFFFFFFFF);
      carry = sum >> 32;
    }
  }
  std::array<std::uint32_t, 10> words_{};
};

/// The mantissa and the exponent of a float, an integer times a power of two.
std::pair<std::int64_t, int> parts_of(float value) {
  int exponent = 0;
  const float fraction = std::frexp(value, &exponent);
  return {static_cast<std::int64_t>(std::ldexp(fraction, 24)), exponent - 24};
}

/// Finite floats of either sign of all magnitudes between two powers of two.
class Floats {
 public:
  explicit Floats(std::uint32_t seed) : random_(seed) {}
  float next(int lowest, int highest) {
    std::uniform_int_distribution<int> exponent(lowest, highest - 1);
    std::uniform_int_distribution<std::int32_t> mantissa(0, (1 << 23) - 1), sign(0, 1);
    const float magnitude = std::ldexp(static_cast<float>(mantissa(random_) + (1 << 23)), exponent(random_) - 23);
    return sign(random_) != 0 ? -magnitude : magnitude;
  }
  Color color(int lowest, int highest) {
    const float red = next(lowest, highest), green = next(lowest, highest);
    return {red, green, next(lowest, highest)};
  }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  std::mt19937& random() { return random_; }

 private:
  std::mt19937 random_;
};

struct Term {
  std::size_t sum, pixel;
  Color color;
};

std::vector<Term> random_terms(std::size_t count, std::uint32_t seed, int lowest = -90, int highest = 33) {
  Floats floats(seed);
  std::vector<Term> terms;
  for (std::size_t i = 0; i < count; ++i)
    terms.push_back({floats.below(kSums), floats.below(kPixels), floats.color(lowest, highest)});
  return terms;
}

TileSums sums_of(const std::vector<Term>& terms) {
  TileSums sums(kSums, kPixels);
  for (const Term& term : terms) {
    sums.add(term.sum, term.pixel, term.color);
    sums.add_coverage(term.pixel, std::fabs(term.color.x));
  }
  return sums;
}

TEST(LightSums, equal_long_arithmetic) {
  Floats floats(1);
  for (int run = 0; run < 200; ++run) {
    Fixed sum;
    LongNumber long_sum;
    for (int i = 0; i < 300; ++i) {
      const float term = floats.next(-57, 30);  // whole steps
      const auto [mantissa, exponent] = parts_of(term);
      const bool is_taken_away = i % 3 == 0;
      if (is_taken_away)
        sum -= fixed_of(term);
      else
        sum += fixed_of(term);
      long_sum.add(is_taken_away ? -mantissa : mantissa, exponent);
    }
    ASSERT_TRUE(sum.bits == long_sum.bits_from(kFixedStep - LongNumber::kLowest)) << run;
    ASSERT_EQ(sum.steps() < 0, long_sum.is_negative()) << run;
  }
}

TEST(LightSums, terms_are_rounded_to_the_nearest_step) {
  const auto steps = [](float term) { return static_cast<std::int64_t>(fixed_of(term).steps()); };
  EXPECT_EQ(steps(0x1p-80F), 1);
  EXPECT_EQ(steps(-0x1p-80F), -1);
  EXPECT_EQ(steps(0x1p-81F), 0);  // ties to even
  EXPECT_EQ(steps(0x1.000002p-81F), 1);
  EXPECT_EQ(steps(0x1.8p-80F), 2);
  EXPECT_EQ(steps(-0x1.8p-80F), -2);
  EXPECT_EQ(steps(0x1.4p-79F), 2);
  EXPECT_EQ(steps(0x1.fffffep-82F), 0);
  EXPECT_EQ(steps(std::numeric_limits<float>::denorm_min()), 0);
  EXPECT_EQ(steps(0), 0);
  EXPECT_EQ(steps(-0.0F), 0);
  Floats floats(2);
  for (int i = 0; i < 20000; ++i) {
    const float term = floats.next(-84, -54);
    // A double holds a term in steps exactly, and rounds it like this.
    const double rounded = std::nearbyint(std::ldexp(static_cast<double>(term), -kFixedStep));
    ASSERT_EQ(steps(term), static_cast<std::int64_t>(rounded)) << term;
  }
}

TEST(LightSums, every_power_of_two_has_its_place) {
  for (int power = kFixedStep; power <= 30; ++power) {
    const float term = std::ldexp(1.0F, power);
    EXPECT_TRUE(fixed_of(term).bits == Uint128{1} << (power - kFixedStep)) << power;
    EXPECT_TRUE(fixed_of(-term).bits == -(Uint128{1} << (power - kFixedStep))) << power;
    EXPECT_EQ(value_of(fixed_of(term)), static_cast<double>(term)) << power;
    EXPECT_EQ(value_of(fixed_of(-term)), -static_cast<double>(term)) << power;
  }
}

TEST(LightSums, values_are_the_nearest_doubles) {
  Floats floats(3);
  std::uniform_int_distribution<std::uint64_t> word;
  std::uniform_int_distribution<int> shift(0, 126);
  for (int i = 0; i < 50000; ++i) {
    Uint128 bits = (Uint128{word(floats.random())} << 64 | word(floats.random())) >> (1 + shift(floats.random()));
    if (i % 3 == 0) bits &= ~Uint128{0} << shift(floats.random());  // ties among them
    const double value = value_of({bits});
    // Not further away than the doubles beside it, exactly: in units of 2^-54 of its own power of two.
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    const auto whole = static_cast<Uint128>(std::ldexp(fraction, 53));
    const int places = exponent - 53 - kFixedStep;
    if (places <= 0) {
      ASSERT_TRUE(whole == bits << -places);
    } else {
      const Uint128 near = whole << places, half = Uint128{1} << (places - 1);
      const Uint128 distance = near > bits ? near - bits : bits - near;
      ASSERT_TRUE(distance < half || (distance == half && (whole & 1U) == 0)) << i;
    }
    ASSERT_EQ(value_of({-bits}), -value);
  }
}

TEST(LightSums, large_terms_are_clamped_and_counted) {
  TileSums sums(kSums, kPixels);
  const float infinity = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
  sums.add(0, 3, Color(0x1p30F, -0x1p30F, 0x1.fffffep29F));
  EXPECT_EQ(sums.clamped(), 0U);
  sums.add(1, 3, Color(0x1.000002p30F, -infinity, none));
  sums.add(1, 4, Color(infinity, 1, 1));
  sums.add_coverage(3, none);
  EXPECT_EQ(sums.clamped(), 5U);
  EXPECT_EQ(sums.value(1, 3), (std::array{0x1p30, -0x1p30, 0.0}));
  EXPECT_EQ(sums.coverage(3), 0);
  sums.subtract(1, 3, Color(0x1.000002p30F, -infinity, none));
  EXPECT_EQ(sums.clamped(), 2U);
  EXPECT_EQ(sums.value(1, 3), (std::array{0.0, 0.0, 0.0}));
  sums.clear(1);
  sums.subtract_coverage(3, none);
  EXPECT_EQ(sums.clamped(), 0U);
}

TEST(LightSums, have_no_order) {
  std::vector<Term> terms = random_terms(2000, 4);
  const TileSums sums = sums_of(terms);
  Floats floats(5);
  for (int run = 0; run < 5; ++run) {
    std::ranges::shuffle(terms, floats.random());
    EXPECT_EQ(sums_of(terms), sums);
    EXPECT_EQ(PackedSums::pack(sums_of(terms)), PackedSums::pack(sums));
  }
}

TEST(LightSums, what_is_subtracted_leaves_no_trace) {
  const std::vector<Term> stay = random_terms(500, 6), go = random_terms(500, 7);
  TileSums sums = sums_of(stay);
  std::vector<Term> order = go;
  for (const Term& term : order) sums.add(term.sum, term.pixel, term.color);
  Floats floats(8);
  std::ranges::shuffle(order, floats.random());
  for (const Term& term : order) sums.subtract(term.sum, term.pixel, term.color);
  EXPECT_EQ(sums, sums_of(stay));
  for (const Term& term : stay) {
    sums.subtract(term.sum, term.pixel, term.color);
    sums.subtract_coverage(term.pixel, std::fabs(term.color.x));
  }
  EXPECT_EQ(sums, TileSums(kSums, kPixels));
  EXPECT_TRUE(sums.is_zero(0));
  EXPECT_EQ(PackedSums::pack(sums), PackedSums::pack(TileSums(kSums, kPixels)));
}

TEST(LightSums, parts_and_differences_add_up) {
  const std::vector<Term> terms = random_terms(900, 9);
  TileSums sums(kSums, kPixels);
  for (std::size_t part = 0; part < 3; ++part) {
    const auto first = terms.begin() + static_cast<std::ptrdiff_t>(300 * part);
    sums.add(sums_of({first, first + 300}));
  }
  EXPECT_EQ(sums, sums_of(terms));
  TileSums difference(kSums, kPixels);  // one term becomes another
  difference.subtract(terms[5].sum, terms[5].pixel, terms[5].color);
  difference.add(1, 2, Color(5, 6, 7));
  sums.add(difference);
  std::vector<Term> edited = terms;
  edited[5] = {1, 2, Color(5, 6, 7)};
  TileSums expected(kSums, kPixels);
  for (const Term& term : edited) expected.add(term.sum, term.pixel, term.color);
  for (const Term& term : terms) expected.add_coverage(term.pixel, std::fabs(term.color.x));
  EXPECT_EQ(sums, expected);
}

TEST(LightSums, follow_the_order_of_the_lights) {
  const TileSums sums = sums_of(random_terms(200, 10));
  const std::array<std::uint32_t, 5> order{3, kNewSum, 0, 1, 2};
  const TileSums next = sums.remapped(order);
  ASSERT_EQ(next.sums(), 5U);
  EXPECT_TRUE(next.is_zero(1));
  EXPECT_EQ(next.value(0, 7), sums.value(3, 7));
  EXPECT_EQ(next.coverage(7), sums.coverage(7));
  EXPECT_EQ(next.clamped(), sums.clamped());
  const std::array<std::uint32_t, 4> back{2, 3, 4, 0};
  EXPECT_EQ(next.remapped(back), sums);
  EXPECT_EQ(PackedSums::pack(sums).remapped(order), PackedSums::pack(next));
  const std::array<std::uint32_t, 2> fewer{1, 3};
  EXPECT_EQ(PackedSums::pack(sums).remapped(fewer).unpack(), sums.remapped(fewer));
}

}  // namespace
}  // namespace relook
