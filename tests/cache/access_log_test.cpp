// Access logs and trials of policies on them.
#include "cache/residency/access_log.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace relook {
namespace {

AccessLog parsed(const std::string& lines) { return parse_access_log(std::string(kAccessLogHeader) + lines, "log"); }

/// Each change uses one piece of 10 bytes that takes a second to have back.
AccessLog uses(const std::vector<int>& pieces) {
  std::string lines;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    lines += std::to_string(i + 1) + " ray_trees " + std::to_string(pieces[i]) + " 10 1 1\n";
  return parsed(lines);
}

TEST(AccessLog, is_read_back) {
  const AccessLog log = parsed("1 ray_trees 7 100 0.5 1\n1 tunnels 7 30 0.25 0.5\n3 ray_trees 7 200 1e-3 1\n");
  ASSERT_EQ(log.accesses.size(), 3U);
  EXPECT_EQ(log.pieces, 2U);
  EXPECT_EQ(log.accesses[2].piece, log.accesses[0].piece);
  EXPECT_EQ(log.accesses[1].facts.surface_area, 0.5);
  EXPECT_EQ(log.accesses[2].facts.return_seconds, 1e-3);
  EXPECT_EQ(log.total_bytes(), 230U);
  EXPECT_EQ(log.largest_bytes(), 200U);
}

TEST(AccessLog, what_is_wrong_is_named_by_its_line) {
  const std::pair<const char*, const char*> wrong[] = {
      {"1 ray_trees 7 100 0.5\n", "line 2"},    {"1 ray_trees 7 100 0.5 1 9\n", "line 2"},
      {"1 ray_trees -7 100 0.5 1\n", "a tile"}, {"1 ray_trees 7 x 0.5 1\n", "bytes"},
      {"1 ray_trees 7 1 nan 1\n", "seconds"},   {"2 a 7 1 1 1\n1 a 7 1 1 1\n", "line 3"},
      {"1 ray_trees 7 1 1 1", "cut off"}};
  for (const auto& [lines, part] : wrong) {
    try {
      (void)parsed(lines);
      ADD_FAILURE() << lines;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW((void)parse_access_log("something else", "log"), InputError);
}

TEST(Trial, nothing_comes_back_when_all_fits) {
  const AccessLog log = uses({1, 2, 3, 1, 2, 3});
  for (const EvictionPolicy policy : kEvictionPolicies) EXPECT_EQ(try_policy(log, policy, 30).returns, 0U);
  EXPECT_EQ(try_clairvoyant(log, 30).returns, 0U);
}

TEST(Trial, a_loop_beats_lru_but_not_who_knows_the_future) {
  const AccessLog log = uses({1, 2, 3, 1, 2, 3, 1, 2, 3});
  EXPECT_EQ(try_policy(log, EvictionPolicy::lru, 20).returns, 6U) << "the classic";
  EXPECT_EQ(try_clairvoyant(log, 20).returns, 3U) << "Belady's answer";
  EXPECT_EQ(try_clairvoyant(log, 20).seconds, 3.0);
}

TEST(Trial, the_weight_keeps_what_is_dear) {
  const AccessLog log =
      parsed("1 a 1 10 9 1\n2 a 2 10 1 1\n3 a 3 10 1 1\n4 a 1 10 9 1\n5 a 2 10 1 1\n6 a 3 10 1 1\n7 a 1 10 9 1\n");
  EXPECT_LT(try_policy(log, EvictionPolicy::weight, 20).seconds, try_policy(log, EvictionPolicy::lru, 20).seconds);
}

}  // namespace
}  // namespace relook
