// What stands on a shadow segment after a change (paper 4.2), against sets of objects that are counted afresh.
#include "trace/shadow/shadow_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <set>

#include "random_changes.h"

namespace relook {
namespace {

enum class Role { steady, then, now };

struct LineObject {
  Role role = Role::steady;
  bool is_transparent = false;
  std::vector<Crossing> crossings;
};

/// Objects at random places of one segment. Places are whole numbers, so that many coincide.
std::vector<LineObject> random_objects(Dice& dice) {
  std::vector<LineObject> objects(1 + dice.below(6));
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    objects[i].role = std::array{Role::steady, Role::steady, Role::then, Role::now}[dice.below(4)];
    objects[i].is_transparent = dice.chance(0.4);
    std::set<std::uint64_t> places;
    for (std::uint64_t k = 1 + dice.below(3); k > 0; --k) places.insert(dice.below(9));
    for (const std::uint64_t place : places)
      objects[i].crossings.push_back(
          {ObjectId(i), {static_cast<std::uint32_t>(place), 0, 0}, static_cast<float>(place), i});
  }
  return objects;
}

/// Crossings of some objects, in order.
template <class Wanted>
std::vector<Crossing> crossings_of(const std::vector<LineObject>& objects, const Wanted& wanted) {
  std::vector<Crossing> all;
  for (const LineObject& object : objects)
    if (wanted(object)) all.insert(all.end(), object.crossings.begin(), object.crossings.end());
  std::ranges::sort(all, {}, place_on_segment);
  return all;
}

/// By interval between the transparent ones, how many opaque objects stand there.
struct CountedLine {
  std::vector<Crossing> surfaces;
  std::vector<std::set<std::uint32_t>> blockers{1};

  CountedLine(const std::vector<LineObject>& objects, Role without) {
    const auto is_there = [&](const LineObject& object) { return object.role != without; };
    for (const Crossing& crossing : crossings_of(objects, is_there)) {
      if (objects[crossing.object.index()].is_transparent) {
        surfaces.push_back(crossing);
        blockers.emplace_back();
      } else {
        blockers.back().insert(crossing.object.index());
      }
    }
  }
  [[nodiscard]] std::vector<std::uint32_t> counters(std::uint32_t bits) const {
    std::vector<std::uint32_t> words;
    for (const auto& objects : blockers) words.push_back(ShadowCounter::of(objects.size(), bits).word());
    return words;
  }
  [[nodiscard]] std::size_t number_of(const std::vector<LineObject>& objects, std::size_t interval, Role role) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(blockers[interval], [&](std::uint32_t object) { return objects[object].role == role; }));
  }
};

SelectionCrossings selection_of(const std::vector<LineObject>& objects, Role role) {
  const auto has = [&](bool transparent) {
    return [=](const LineObject& object) { return object.role == role && object.is_transparent == transparent; };
  };
  return {crossings_of(objects, has(false)), crossings_of(objects, has(true))};
}

struct LineCounts {
  std::uint64_t known = 0, known_with_new_surfaces = 0, afresh = 0, overflows = 0;
};

void compare_lines(const std::vector<LineObject>& objects, std::uint32_t bits, LineCounts& counts) {
  const CountedLine before(objects, Role::now), after(objects, Role::then);
  const SelectionCrossings then = selection_of(objects, Role::then), now = selection_of(objects, Role::now);
  const auto is_steady_glass = [](const LineObject& o) { return o.role == Role::steady && o.is_transparent; };
  ShadowLine line(bits);
  ASSERT_TRUE(line.start(crossings_of(objects, is_steady_glass), then.transparent, before.counters(bits)));
  const bool is_known = line.exchange(then, now);
  if (is_known) {
    ASSERT_TRUE(std::ranges::equal(line.surfaces(), after.surfaces));
    const std::vector<std::uint32_t> words = after.counters(bits);
    const std::span<const std::uint32_t> entry = line.entry();
    ASSERT_EQ(entry.size(), 1 + after.surfaces.size() + words.size());
    ASSERT_TRUE(std::ranges::equal(entry.subspan(1 + after.surfaces.size()), words));
    ASSERT_EQ(line.is_blocked(), std::ranges::any_of(words, [](std::uint32_t word) { return word != 0; }));
  }
  const bool same_surfaces = then.transparent.empty() && now.transparent.empty();
  ++(!is_known ? counts.afresh : same_surfaces ? counts.known : counts.known_with_new_surfaces);
  if (!same_surfaces) return;
  bool is_lost = false;  // fewer than before of more than counters tell
  for (std::size_t i = 0; i < before.blockers.size(); ++i)
    is_lost = is_lost || (before.blockers[i].size() > ShadowCounter::most(bits) &&
                          before.number_of(objects, i, Role::then) > after.number_of(objects, i, Role::now));
  ASSERT_EQ(is_known, !is_lost);
  counts.overflows += is_lost ? 1 : 0;
}

TEST(ShadowLine, is_the_line_counted_afresh_and_asks_for_that_only_where_it_must) {
  const std::uint64_t seed = seed_of_run();
  std::cout << "RELOOK_SEED=" << seed << "\n";
  Dice dice(seed);
  for (std::uint32_t bits = 1; bits <= ShadowCounter::kMostBits; ++bits) {
    LineCounts counts;
    for (int k = 0; k < 20000; ++k) {
      ASSERT_NO_FATAL_FAILURE(compare_lines(random_objects(dice), bits, counts)) << bits << " bits, line " << k;
    }
    EXPECT_GT(counts.known, 1000U);
    EXPECT_GT(counts.known_with_new_surfaces, 1000U);
    EXPECT_GT(counts.afresh, 0U);
    EXPECT_EQ(counts.overflows > 0, bits < 3) << "at most six objects";
  }
}

TEST(ShadowLine, that_does_not_fit_its_counters_is_not_taken) {
  const std::array<std::uint32_t, 2> counters{1, 1};
  EXPECT_FALSE(ShadowLine(2).start({}, {}, counters));  // as a damaged cache may have it
}

}  // namespace
}  // namespace relook
