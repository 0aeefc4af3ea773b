// The budget from change to change: what the process holds beside pieces, measured, claimed and foreseen, and the floor
// below which a limit is refused.
#include <algorithm>
#include <utility>

#include "base/error.h"
#include "cache/residency/residency.h"

namespace relook {
namespace {

/// A limit is refused when it is less than the floor by more than one of so many parts: of two runs with one limit, the
/// floor that one names is good for the other.
constexpr std::uint64_t kSlack = 32;

/// A size as the command line reads it, in MiB, rounded up.
std::string megabytes(std::uint64_t bytes) { return std::to_string((bytes + (1U << 20) - 1) >> 20) + "M"; }

}  // namespace

std::uint64_t Residency::outside_now() const {
  const std::uint64_t resident = options_.process_bytes ? options_.process_bytes() : 0, known = known_bytes();
  // While a cache is read, what comes next is not there yet.
  return (resident > known ? resident - known : 0) + (change_ == 0 && !is_aside_ ? reserve_bytes_ : 0);
}

void Residency::measure_outside() {
  const std::uint64_t before = outside_bytes_, now = outside_now();
  aside_most_ = std::max(aside_most_, now);
  outside_bytes_ = std::max(before, now);
  if (outside_bytes_ == before || fits(0) || trims_left_ == 0) return;
  --trims_left_;
  trim_allocator();
  outside_bytes_ = std::max(before, outside_now());
}

void Residency::begin_change() {
  const std::lock_guard lock(mutex_);
  ++change_;
  candidates_.clear();
  trims_left_ = kMostTrims;
  if (!is_limited()) return;
  trim_allocator();
  base_bytes_ = outside_now();
  claimed_bytes_ = 0;
  if (change_ > 1 && outside_bytes_ > base_bytes_)
    reserve_bytes_ = std::max(reserve_bytes_, outside_bytes_ - base_bytes_);
  outside_bytes_ = base_bytes_ + reserve_bytes_;
  if (!make_room_locked(0) || change_ == 1) require_floor_locked();
}

void Residency::set_needs(const MemoryNeeds& needs) {
  const std::lock_guard lock(mutex_);
  needs_ = needs;
  reserve_bytes_ = std::max(reserve_bytes_, needs.change_bytes);
}

Residency::Aside Residency::begin_aside() {
  if (!is_limited()) return Aside(nullptr);
  require(!is_aside_, "one thing is done aside at a time");
  Aside aside(this);  // ends, too, if there is no room
  const std::lock_guard lock(mutex_);
  is_aside_ = true;
  candidates_.clear();
  trims_left_ = kMostTrims;
  trim_allocator();
  before_aside_ = aside_most_ = outside_now();
  outside_of_change_ = std::exchange(outside_bytes_, before_aside_ + needs_.aside_bytes);
  if (!make_room_locked(0) || change_ == 0) require_floor_locked();
  return aside;
}

void Residency::measure_aside() {
  if (!is_limited()) return;
  const std::lock_guard lock(mutex_);
  if (is_aside_) make_room_locked(0);
}

void Residency::end_aside() {
  const std::lock_guard lock(mutex_);
  is_aside_ = false;
  candidates_.clear();
  outside_bytes_ = outside_of_change_;
  if (aside_most_ > before_aside_) needs_.aside_bytes = aside_most_ - before_aside_;
}

void Residency::claim(std::int64_t bytes) {
  if (!options_.process_bytes) return;
  const std::lock_guard lock(mutex_);
  if (is_aside_) {
    if (bytes <= 0) return;
    outside_bytes_ = std::max(outside_bytes_, outside_now() + static_cast<std::uint64_t>(bytes));
    make_room_locked(0);
    return;
  }
  claimed_bytes_ += bytes;
  // What is given back makes no room: its owner may be going, with whatever else could leave.
  if (bytes <= 0 || claimed_bytes_ <= 0) return;
  outside_bytes_ = std::max(outside_bytes_, base_bytes_ + static_cast<std::uint64_t>(claimed_bytes_) + reserve_bytes_);
  make_room_locked(0);
}

void Residency::require_floor() {
  if (!is_limited()) return;
  const std::lock_guard lock(mutex_);
  if (!make_room_locked(0)) require_floor_locked();
}

/// Before anything has been measured, what all changes and what is done aside will need is foreseen, beside what is
/// there. Later most of that is there.
std::uint64_t Residency::floor_bytes() const {
  const auto at_least_0 = [](std::int64_t bytes) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(bytes, 0));
  };
  std::uint64_t stays = is_aside_ ? before_aside_ : base_bytes_ + at_least_0(claimed_bytes_);
  for (const Kind& kind : kinds_)
    for (const Piece& p : kind.pieces) {
      const bool may_leave = p.pins == 0 && (spill_ || kind.handler.may_be_missing);
      if (p.state == State::resident && !may_leave) stays += p.facts.bytes;
    }
  const std::uint64_t change = needs_.change_bytes, aside = needs_.aside_bytes;
  if (change_ > (is_aside_ ? 0U : 1U)) return stays + (is_aside_ ? aside : change / 4);
  const std::uint64_t built = std::min(at_least_0(claimed_bytes_), needs_.structures_bytes);
  // About half of what changes take stays in the end.
  return stays + needs_.structures_bytes - built + std::max(change, aside > 0 ? change / 2 + aside : 0);
}

void Residency::require_floor_locked() const {
  const std::uint64_t needed = floor_bytes(), limit = *options_.memory_bytes;
  // What is foreseen differs by some percent from run to run, with the allocator: what is named is enough for each.
  constexpr std::uint64_t kNamedSlack = 16;
  if (needed > limit + limit / kSlack)
    throw ResourceError("--memory", "this replay needs at least " + megabytes(needed + needed / kNamedSlack));
}

}  // namespace relook
