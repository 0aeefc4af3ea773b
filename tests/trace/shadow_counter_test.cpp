// Shadow counters (paper 4.2) alone, against an unbounded integer, and the words of a path that holds them.
#include "trace/shadow/shadow_counter.h"

#include <gtest/gtest.h>

#include "trace/tree/grow.h"
#include "unbounded_counter.h"

namespace relook {
namespace {

struct Exhaustion {
  std::uint32_t bits;
  std::uint64_t known = 0, recounts = 0;

  void expect_true(ShadowCounter counter, std::uint64_t blockers) const {
    ASSERT_EQ(counter.word(), word_of(blockers, bits));
    ASSERT_EQ(counter.is_blocked(), blockers > 0);
    ASSERT_EQ(counter.overflows(), blockers >= std::uint64_t{1} << bits);
    ASSERT_EQ(counter, ShadowCounter::of(blockers, bits));
    ASSERT_TRUE(ShadowCounter::is_sound(counter.word(), bits));
    ASSERT_EQ(ShadowCounter::from_word(counter.word(), bits), counter);
  }

  /// All sequences of additions and removals of up to three blockers, `length` long.
  void visit(ShadowCounter counter, std::uint64_t blockers, int length) {
    expect_true(counter, blockers);
    if (length == 0 || testing::Test::HasFatalFailure()) return;
    for (std::uint32_t k = 0; k <= 3; ++k) {
      visit(counter.added(k), blockers + k, length - 1);
      if (k > blockers) continue;
      const std::optional<ShadowCounter> fewer = counter.removed(k);
      if (!fewer) {
        ASSERT_TRUE(counter.overflows() && k > 0);
        ++recounts;
      } else {
        ++known;
      }
      visit(fewer.value_or(ShadowCounter::of(blockers - k, bits)), blockers - k, length - 1);
    }
  }
};

TEST(ShadowCounter, says_the_same_as_an_unbounded_integer_or_asks_for_a_recount) {
  for (std::uint32_t bits = 0; bits <= ShadowCounter::kMostBits; ++bits) {
    Exhaustion all{bits};
    for (const std::uint64_t start : {std::uint64_t{0}, (std::uint64_t{1} << bits) - 1})
      all.visit(ShadowCounter::of(start, bits), start, 6);
    EXPECT_GT(all.known, 0U);
    EXPECT_GT(all.recounts, 0U);
    EXPECT_FALSE(ShadowCounter::is_sound((1U << bits) + 1, bits));
  }
}

TEST(ShadowCounter, one_flag_is_left_of_it_without_bits) {
  EXPECT_FALSE(ShadowCounter::of(0, 0).is_blocked());
  EXPECT_EQ(ShadowCounter::of(1, 0), ShadowCounter::of(1000, 0));
  EXPECT_FALSE(ShadowCounter::of(1, 0).removed(1).has_value());
  EXPECT_TRUE(ShadowCounter::of(1, 0).removed(0).has_value());
}

TEST(ShadowCounter, fewer_blockers_counted_than_there_are_is_a_recount_and_no_abort) {
  EXPECT_FALSE(ShadowCounter::of(1, 2).removed(2).has_value());  // as a cache with correct hashes may have it
  EXPECT_FALSE(ShadowCounter::of(0, 2).removed(1).has_value());
}

TEST(ShadowCounter, paths_with_malformed_entries_are_found_out) {
  // Object 0 under two lights: the first is blocked (3), the second filtered (2): 2 << 2 | 3.
  const std::vector<std::uint32_t> sound = {0, 0, 11, 1, 1, 4, 0, 2, 1, 1};  // 1 surface, counters {4, 0}; 2 filters
  const PathLayout layout{2, 2};
  const auto is_broken = [&](std::size_t place, std::uint32_t word) {
    std::vector<std::uint32_t> words = sound;
    words[place] = word;
    return !broken_invariants(words, 2, layout).empty();
  };
  EXPECT_TRUE(broken_invariants(sound, 2, layout).empty());
  EXPECT_EQ(hit_count(sound, layout), 3U);  // the node and two filters
  EXPECT_TRUE(is_broken(3, 0));             // entries shifted
  EXPECT_TRUE(is_broken(3, 0xFFFFFFFFU));   // more surfaces than words
  EXPECT_TRUE(is_broken(4, 2));             // no such object
  EXPECT_TRUE(is_broken(5, 5));             // more than the overflow flag
  EXPECT_TRUE(is_broken(5, 0));             // blocked by nothing
  EXPECT_TRUE(is_broken(9, 2));             // no such filter
  EXPECT_FALSE(is_broken(6, 3));
  for (std::size_t length = 0; length < sound.size(); ++length)
    EXPECT_FALSE(broken_invariants(std::span(sound).first(length), 2, layout).empty()) << length;
  EXPECT_FALSE(broken_invariants(sound, 2, {2, 0}).empty());
}

}  // namespace
}  // namespace relook
