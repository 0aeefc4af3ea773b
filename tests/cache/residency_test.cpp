// Residency by itself: what leaves, what comes back, and in which order.
#include "cache/residency/residency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "base/error.h"

namespace relook {
namespace {

constexpr std::size_t kTiles = 8;
constexpr std::uint64_t kPieceBytes = 1000;

/// Pieces of 1000 bytes, each with its own value in them.
constexpr auto kTunnels = static_cast<std::size_t>(PieceKind::tunnels);

class Residence : public testing::Test {
 protected:
  Residency& start(std::uint64_t memory_bytes, bool has_disk, bool may_be_missing = true,
                   EvictionPolicy policy = EvictionPolicy::weight) {
    ResidencyOptions options;
    options.memory_bytes = memory_bytes;
    options.policy = policy;
    options.process_bytes = [this] { return outside_bytes_; };
    if (has_disk) options.spill_folder = testing::TempDir();
    residency_.emplace(std::move(options));
    PieceHandler handler;
    handler.pack = [this](std::size_t tile) { return pieces_[tile]; };
    handler.unpack = [this](std::size_t tile, BytesView bytes) { pieces_[tile].assign(bytes.begin(), bytes.end()); };
    handler.drop = [this](std::size_t tile) { pieces_[tile] = {}; };
    handler.may_be_missing = may_be_missing;
    residency_->add_kind(PieceKind::ray_trees, kTiles, std::move(handler));
    return *residency_;
  }
  void set(std::size_t tile, double rebuild_seconds = 1, std::uint64_t bytes = kPieceBytes) {
    pieces_[tile].assign(bytes, static_cast<std::byte>(tile + 1));
    residency_->set(PieceKind::ray_trees, tile, bytes, rebuild_seconds);
  }
  void use(std::size_t tile) { const auto lease = residency_->use(PieceKind::ray_trees, tile); }
  [[nodiscard]] bool is_resident(std::size_t tile) const { return !pieces_[tile].empty(); }
  [[nodiscard]] std::vector<std::size_t> residents() const {
    std::vector<std::size_t> tiles;
    for (std::size_t tile = 0; tile < kTiles; ++tile)
      if (is_resident(tile)) tiles.push_back(tile);
    return tiles;
  }

  std::uint64_t outside_bytes_ = 0;
  std::array<Bytes, kTiles> pieces_;
  std::optional<Residency> residency_;
};

using Tiles = std::vector<std::size_t>;

TEST_F(Residence, writes_no_derived_pieces_and_does_not_count_them) {
  Residency& residency = start(3 * kPieceBytes, true);
  std::array<bool, kTiles> is_there{};
  PieceHandler derived;
  derived.drop = [&](std::size_t tile) { is_there[tile] = false; };
  derived.may_be_missing = derived.is_derived = true;
  residency.add_kind(PieceKind::light_layers, kTiles, std::move(derived));
  for (std::size_t tile = 0; tile < kTiles; ++tile) {
    is_there[tile] = true;
    residency.set(PieceKind::light_layers, tile, kPieceBytes, 1e-6);
  }
  EXPECT_EQ(std::ranges::count(is_there, true), 3);
  for (std::size_t tile = 0; tile < kTiles; ++tile) {
    const bool was_there = is_there[tile];
    const auto lease = residency.use(PieceKind::light_layers, tile);
    EXPECT_EQ(is_there[tile], was_there) << "nothing brings them back";
  }
  set(0);  // what takes longer to have back stays, they go
  EXPECT_TRUE(is_resident(0));
  EXPECT_EQ(std::ranges::count(is_there, true), 2);
  const PieceCounts counts = residency.take_counts();
  EXPECT_EQ(counts.evicted, PieceCounts().evicted);
  EXPECT_EQ(counts.reloaded, PieceCounts().reloaded);
  EXPECT_EQ(counts.evicted_bytes, 0U);
}

TEST_F(Residence, keeps_within_the_limit_and_gives_back_what_was_spilled) {
  Residency& residency = start(3 * kPieceBytes, true);
  for (std::size_t tile = 0; tile < kTiles; ++tile) set(tile);
  EXPECT_EQ(residents().size(), 3U);
  for (std::size_t tile = 0; tile < kTiles; ++tile) {
    const auto lease = residency.use(PieceKind::ray_trees, tile);
    EXPECT_EQ(pieces_[tile], Bytes(kPieceBytes, static_cast<std::byte>(tile + 1)));
    EXPECT_LE(residents().size(), 3U);
  }
  const PieceCounts counts = residency.take_counts();
  EXPECT_GE(counts.reloaded[0], 5U);
  EXPECT_GE(counts.evicted[0], 5U);
  EXPECT_EQ(counts.evicted_bytes, counts.evicted[0] * kPieceBytes);
  EXPECT_EQ(counts.reloaded_bytes, counts.reloaded[0] * kPieceBytes);
  EXPECT_EQ(residency.take_counts().evicted[0], 0U);
}

TEST_F(Residence, makes_room_for_work_aside_before_it_is_taken_and_forgets_it_afterwards) {
  outside_bytes_ = 1000;
  Residency& residency = start(outside_bytes_ + 8 * kPieceBytes, true);
  residency.set_needs({.change_bytes = 0, .aside_bytes = 2 * kPieceBytes, .structures_bytes = 0});
  for (std::size_t tile = 0; tile < kTiles; ++tile) set(tile);
  outside_bytes_ = 1000 + 8 * kPieceBytes;  // pieces are of the process, too
  residency.begin_change();
  EXPECT_EQ(residents().size(), 8U);
  const auto settle = [&](std::uint64_t aside) { outside_bytes_ = 1000 + residents().size() * kPieceBytes + aside; };
  {
    const Residency::Aside aside = residency.begin_aside();
    EXPECT_EQ(residents().size(), 6U) << "what the needs foresee";
    settle(2000);
    residency.claim(1000);
    EXPECT_EQ(residents().size(), 5U) << "one more is about to be taken";
    settle(3000);
    residency.measure_aside();
    EXPECT_EQ(residents().size(), 5U);
    settle(4000);
    residency.measure_aside();
    EXPECT_EQ(residents().size(), 4U) << "more than was claimed";
    settle(4000);
  }
  settle(0);
  residency.begin_change();
  for (std::size_t tile = 0; tile < kTiles; ++tile) {
    use(tile);
    settle(0);
  }
  EXPECT_EQ(residents().size(), 8U) << "what was held aside is no need of changes";
  const Residency::Aside again = residency.begin_aside();
  EXPECT_EQ(residents().size(), 4U) << "as much as the last time";
}

TEST_F(Residence, names_a_floor_with_all_that_is_foreseen) {
  outside_bytes_ = 100 << 20;
  Residency& residency = start(50 << 20, true);
  constexpr std::uint64_t kMegabyte = 1 << 20;
  const auto floor_with = [&](const MemoryNeeds& needs) -> std::string {
    residency.set_needs(needs);
    try {
      const Residency::Aside aside = residency.begin_aside();
    } catch (const ResourceError& error) {
      return error.what();
    }
    return "";
  };
  // A sixteenth more than what is foreseen.
  EXPECT_EQ(floor_with({8 * kMegabyte, 0, 0}), "--memory: this replay needs at least 115M");
  EXPECT_EQ(floor_with({8 * kMegabyte, 0, 5 * kMegabyte}), "--memory: this replay needs at least 121M");
  EXPECT_EQ(floor_with({8 * kMegabyte, 20 * kMegabyte, 5 * kMegabyte}), "--memory: this replay needs at least 138M");
}

TEST_F(Residence, a_piece_on_disk_is_read_once_for_all_who_ask_at_the_same_time) {
  Residency& residency = start(3 * kPieceBytes, true);
  std::atomic<int> reads = 0, reading = 0;
  PieceHandler slow;
  slow.pack = [this](std::size_t tile) { return pieces_[tile]; };
  slow.drop = [this](std::size_t tile) { pieces_[tile] = {}; };
  slow.unpack = [&](std::size_t tile, BytesView bytes) {
    ++reads;
    EXPECT_EQ(++reading, 1);
    pieces_[tile].assign(bytes.begin(), bytes.begin() + 1);  // half there
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    pieces_[tile].assign(bytes.begin(), bytes.end());
    --reading;
  };
  residency.add_kind(PieceKind::ray_trees, kTiles, std::move(slow));
  for (std::size_t tile = 0; tile < kTiles; ++tile) set(tile);
  ASSERT_FALSE(is_resident(0));
  std::vector<std::thread> users;
  for (int i = 0; i < 4; ++i)
    users.emplace_back([&] {
      const auto lease = residency.use(PieceKind::ray_trees, 0);
      EXPECT_EQ(pieces_[0], Bytes(kPieceBytes, std::byte{1}));
    });
  for (std::thread& user : users) user.join();
  EXPECT_EQ(reads, 1);
}

TEST_F(Residence, what_is_stored_is_fetched_when_used_and_leaves_without_a_copy) {
  Residency& residency = start(3 * kPieceBytes, true, true, EvictionPolicy::lru);
  int packed = 0;
  PieceHandler handler;
  handler.pack = [&](std::size_t tile) {
    ++packed;
    return pieces_[tile];
  };
  handler.unpack = [this](std::size_t tile, BytesView bytes) { pieces_[tile].assign(bytes.begin(), bytes.end()); };
  handler.drop = [this](std::size_t tile) { pieces_[tile] = {}; };
  handler.fetch = [this](std::size_t tile) -> std::optional<std::uint64_t> {
    if (tile == 7) return std::nullopt;  // damaged
    pieces_[tile].assign(kPieceBytes, std::byte{42});
    return kPieceBytes;
  };
  handler.may_be_missing = true;
  residency.add_kind(PieceKind::tunnels, kTiles, std::move(handler));
  const auto use_tunnels = [&](std::size_t tile) { const auto lease = residency.use(PieceKind::tunnels, tile); };
  for (std::size_t tile = 0; tile < kTiles; ++tile) residency.set_stored(PieceKind::tunnels, tile, kPieceBytes, 1, 1);
  EXPECT_TRUE(residents().empty()) << "nothing is fetched before it is used";
  for (int round = 0; round < 2; ++round)
    for (std::size_t tile = 0; tile < 6; ++tile) {
      use_tunnels(tile);
      EXPECT_EQ(pieces_[tile], Bytes(kPieceBytes, std::byte{42}));
      EXPECT_LE(residents().size(), 3U);
    }
  EXPECT_EQ(packed, 0);
  PieceCounts counts = residency.take_counts();
  EXPECT_EQ(counts.fetched[kTunnels], 6U) << "each once";
  EXPECT_EQ(counts.reloaded[kTunnels], 6U) << "each comes back once";
  EXPECT_EQ(counts.evicted[kTunnels], 9U);
  use_tunnels(7);
  EXPECT_FALSE(is_resident(7));
  EXPECT_EQ(residency.take_counts().fetched[kTunnels], 0U);
  pieces_[0].assign(kPieceBytes, std::byte{1});  // changed: the store has the old one
  residency.set(PieceKind::tunnels, 0, kPieceBytes, std::nullopt);
  residency.begin_change();
  for (const std::size_t tile : {1U, 2U, 3U, 4U}) use_tunnels(tile);
  EXPECT_FALSE(is_resident(0));
  EXPECT_EQ(packed, 1);
  use_tunnels(0);
  EXPECT_EQ(pieces_[0], Bytes(kPieceBytes, std::byte{1}));
}

TEST_F(Residence, a_piece_that_could_not_be_unpacked_is_on_disk_as_before) {
  Residency& residency = start(3 * kPieceBytes, true);
  bool is_short = true;
  PieceHandler handler;
  handler.pack = [this](std::size_t tile) { return pieces_[tile]; };
  handler.drop = [this](std::size_t tile) { pieces_[tile] = {}; };
  handler.unpack = [&](std::size_t tile, BytesView bytes) {
    pieces_[tile].assign(bytes.begin(), bytes.begin() + 1);
    if (is_short) throw std::bad_alloc();
    pieces_[tile].assign(bytes.begin(), bytes.end());
  };
  residency.add_kind(PieceKind::ray_trees, kTiles, std::move(handler));
  for (std::size_t tile = 0; tile < kTiles; ++tile) set(tile);
  for (int i = 0; i < 3; ++i) EXPECT_THROW(use(0), std::bad_alloc);
  EXPECT_FALSE(is_resident(0));
  is_short = false;
  use(0);
  EXPECT_EQ(pieces_[0], Bytes(kPieceBytes, std::byte{1}));
  for (std::size_t tile = 1; tile < kTiles; ++tile) use(tile);  // no lease was left behind: it can go again
  EXPECT_FALSE(is_resident(0));
  EXPECT_LE(residents().size(), 3U);
}

TEST_F(Residence, expecting_pieces_moves_and_counts_nothing) {
  Residency& residency = start(3 * kPieceBytes, true);
  for (std::size_t tile = 0; tile + 1 < kTiles; ++tile) set(tile);
  const Tiles before = residents();
  static_cast<void>(residency.take_counts());
  for (std::size_t tile = 0; tile < kTiles; ++tile)
    residency.expect(PieceKind::ray_trees, tile);  // the last is missing
  EXPECT_EQ(residents(), before);
  EXPECT_EQ(residency.take_counts().reloaded[0], 0U);
  for (std::size_t tile = 0; tile + 1 < kTiles; ++tile) {
    const auto lease = residency.use(PieceKind::ray_trees, tile);
    EXPECT_EQ(pieces_[tile], Bytes(kPieceBytes, static_cast<std::byte>(tile + 1)));
  }
  EXPECT_GE(residency.take_counts().reloaded[0], kTiles - 1 - 3);
}

TEST_F(Residence, without_a_disk_pieces_go_missing_until_they_are_set_again) {
  Residency& residency = start(2 * kPieceBytes, false);
  set(0, 1);
  set(1, 5);
  set(2, 3);
  EXPECT_EQ(residents(), (Tiles{1, 2}));
  use(0);
  EXPECT_FALSE(is_resident(0));
  residency.begin_change();
  set(0, 9);
  EXPECT_EQ(residents(), (Tiles{0, 1}));
}

TEST_F(Residence, what_is_leased_or_cannot_be_missing_stays) {
  Residency& residency = start(kPieceBytes, false);
  set(0, 1);
  const auto lease = residency.use(PieceKind::ray_trees, 0);
  set(1, 100);
  EXPECT_TRUE(is_resident(0));
  start(kPieceBytes, false, false);
  set(0);
  set(1);
  EXPECT_EQ(residents(), (Tiles{0, 1}));
}

TEST_F(Residence, the_weight_prefers_what_is_dear_small_and_young) {
  Residency& residency = start(3 * kPieceBytes, false);
  set(0, 1);
  set(1, 1);
  set(2, 1);
  for (int k = 0; k < 3; ++k) {
    residency.begin_change();
    use(0);
    use(2);
  }
  set(3, 10);
  EXPECT_EQ(residents(), (Tiles{0, 2, 3})) << "the one not used";
  set(4, 100, 2 * kPieceBytes);
  EXPECT_EQ(residents(), (Tiles{3, 4})) << "the cheap ones";
}

TEST_F(Residence, policies_differ) {
  const auto left = [&](EvictionPolicy policy) {
    pieces_ = {};
    Residency& residency = start(4 * kPieceBytes, false, true, policy);
    set(0, 1, 500);
    set(1, 9, 2000);
    set(2, 2, 1500);
    residency.begin_change();
    use(1);
    residency.begin_change();
    use(0);
    residency.begin_change();
    use(2);
    outside_bytes_ = 4000 + 100;  // as much as the pieces, and a little more
    (void)residency.make_room(0);
    outside_bytes_ = 0;
    return residents();
  };
  EXPECT_EQ(left(EvictionPolicy::lru), (Tiles{0, 2}));
  EXPECT_EQ(left(EvictionPolicy::size), (Tiles{0, 2}));
  EXPECT_EQ(left(EvictionPolicy::weight), (Tiles{1, 2})) << "0: 1 / (500 * 2), 1: 9 / (2000 * 3), 2: 2 / (1500 * 1)";
  EXPECT_EQ(left(EvictionPolicy::gdsf), (Tiles{0, 1}));
}

TEST_F(Residence, a_budget_below_the_floor_is_refused_with_the_floor) {
  outside_bytes_ = std::uint64_t{300} << 20;
  Residency& residency = start(std::uint64_t{200} << 20, true);
  set(0);
  try {
    residency.begin_change();
    FAIL();
  } catch (const ResourceError& error) {
    EXPECT_NE(std::string(error.what()).find("319M"), std::string::npos) << error.what();
  }
}

TEST_F(Residence, claims_make_room_before_they_show) {
  Residency& residency = start(6 * kPieceBytes, true);
  for (std::size_t tile = 0; tile < 6; ++tile) set(tile);
  residency.begin_change();
  residency.claim(2 * kPieceBytes);
  EXPECT_EQ(residents().size(), 4U);
  residency.claim(-static_cast<std::int64_t>(kPieceBytes));
  residency.claim(kPieceBytes);
  EXPECT_EQ(residents().size(), 4U) << "what was given back is taken again";
  residency.claim(2 * kPieceBytes);
  EXPECT_EQ(residents().size(), 2U);
  residency.require_floor();
  outside_bytes_ = 4 * kPieceBytes + residents().size() * kPieceBytes;  // the claims are there now
  residency.begin_change();
  EXPECT_EQ(residents().size(), 2U) << "and count once";
}

TEST_F(Residence, claims_beyond_the_limit_are_refused_with_the_floor) {
  Residency& residency = start(std::uint64_t{200} << 20, true);
  set(0);
  residency.begin_change();
  residency.claim(std::int64_t{250} << 20);
  EXPECT_FALSE(is_resident(0));
  try {
    residency.require_floor();
    FAIL();
  } catch (const ResourceError& error) {
    EXPECT_NE(std::string(error.what()).find("266M"), std::string::npos) << error.what();
  }
}

TEST_F(Residence, others_leave_when_they_weigh_least) {
  Residency& residency = start(3 * kPieceBytes, false);
  std::uint64_t others = kPieceBytes;
  residency.set_others([&] { return others; },
                       [&](std::vector<Victim>& victims) {
                         if (others > 0)
                           victims.push_back({1e-9, [&] { return std::exchange(others, 0) > 0 ? 7U : 0U; }});
                       });
  set(0);
  set(1);
  set(2);
  EXPECT_EQ(residents(), (Tiles{0, 1, 2}));
  EXPECT_EQ(residency.take_counts().others_evicted, 7U);
}

}  // namespace
}  // namespace relook
