#include "cache/residency/residency.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "base/error.h"

namespace relook {
namespace {

std::size_t index_of(PieceKind kind) { return static_cast<std::size_t>(kind); }

/// Of the allocator in one change: each takes some milliseconds.
constexpr std::uint32_t kMostTrims = 32;

/// A limit is refused when it is less than the floor by more than one of so many parts: of two runs with one limit, the
/// floor that one names is good for the other.
constexpr std::uint64_t kSlack = 32;

/// As the command line reads it, rounded up.
std::string megabytes(std::uint64_t bytes) { return std::to_string((bytes + (1U << 20) - 1) >> 20) + "M"; }

}  // namespace

std::string_view kind_name(PieceKind kind) {
  switch (kind) {
    case PieceKind::ray_trees:
      return "ray_trees";
    case PieceKind::sample_colors:
      return "sample_colors";
    case PieceKind::tunnels:
      return "tunnels";
  }
  return "";
}

Residency::Residency(ResidencyOptions options) : options_(std::move(options)), trims_left_(kMostTrims) {
  if (is_limited() && !options_.spill_folder.empty() && options_.disk_bytes > 0)
    spill_ = std::make_unique<SpillFile>(options_.spill_folder, options_.disk_bytes);
  reserve_bytes_ = options_.reserve_bytes;
}

void Residency::add_kind(PieceKind kind, std::size_t tiles, PieceHandler handler) {
  const std::lock_guard lock(mutex_);
  for (Piece& p : kinds_[index_of(kind)].pieces) {
    if (p.state == State::resident) resident_bytes_ -= p.facts.bytes;
    free_copy(p);
  }
  candidates_.clear();
  kinds_[index_of(kind)] = {std::move(handler), std::vector<Piece>(tiles)};
}

void Residency::set_others(std::function<std::uint64_t()> bytes, std::function<void(std::vector<Victim>&)> list) {
  others_bytes_ = std::move(bytes);
  list_others_ = std::move(list);
}

void Residency::free_copy(Piece& piece) {
  if (piece.copy) spill_->free(*piece.copy);
  piece.copy.reset();
}

void Residency::set(PieceKind kind, std::size_t tile, std::uint64_t bytes, std::optional<double> rebuild_seconds,
                    double surface_area) {
  if (!is_watched()) return;
  const std::lock_guard lock(mutex_);
  Piece& p = piece(kind, tile);
  if (p.state == State::resident) resident_bytes_ -= p.facts.bytes;
  free_copy(p);
  p.state = State::resident;
  p.is_stored = false;
  p.facts.bytes = std::max<std::uint64_t>(bytes, 1);
  p.facts.surface_area = surface_area;
  p.rebuild_seconds = rebuild_seconds.value_or(p.rebuild_seconds);
  resident_bytes_ += p.facts.bytes;
  ++p.pins;
  make_room_locked(0);
  --p.pins;
}

void Residency::set_stored(PieceKind kind, std::size_t tile, std::uint64_t bytes, double rebuild_seconds,
                           double surface_area) {
  if (!is_watched()) return;
  const std::lock_guard lock(mutex_);
  Piece& p = piece(kind, tile);
  require(p.state == State::missing && kinds_[index_of(kind)].handler.fetch, "what is stored was not there before");
  p.state = State::stored;
  p.is_stored = true;
  p.facts.bytes = std::max<std::uint64_t>(bytes, 1);
  p.facts.surface_area = surface_area;
  p.rebuild_seconds = rebuild_seconds;
}

void Residency::set_surface_area(PieceKind kind, std::size_t tile, double surface_area) {
  if (!is_watched()) return;
  const std::lock_guard lock(mutex_);
  piece(kind, tile).facts.surface_area = surface_area;
}

Residency::Lease Residency::use(PieceKind kind, std::size_t tile) {
  if (!is_watched()) return {};
  {
    const std::lock_guard lock(mutex_);
    touch(kind, tile);
    ++piece(kind, tile).pins;
  }
  Lease lease(this, kind, tile);  // ends, too, if the piece does not come
  bring_back(kind, tile);
  return lease;
}

void Residency::bring_back(PieceKind kind, std::size_t tile) {
  std::unique_lock lock(mutex_);
  Piece& p = piece(kind, tile);
  loaded_.wait(lock, [&] { return p.state != State::loading; });
  if (p.state != State::spilled && p.state != State::stored) return;
  const State from = p.state;
  make_room_locked(p.facts.bytes);
  resident_bytes_ += p.facts.bytes;
  p.state = State::loading;
  const std::optional<SpillFile::Extent> extent = p.copy;
  lock.unlock();
  const PieceHandler& handler = kinds_[index_of(kind)].handler;
  const auto start = std::chrono::steady_clock::now();
  std::optional<std::uint64_t> bytes = p.facts.bytes;
  const auto settle = [&](State state) {
    lock.lock();
    p.state = state;
    loaded_.notify_all();
  };
  try {
    if (from == State::stored)
      bytes = handler.fetch(tile);
    else
      handler.unpack(tile, spill_->read(*extent));
  } catch (...) {
    handler.drop(tile);  // what is there of it
    settle(from);
    resident_bytes_ -= p.facts.bytes;
    throw;
  }
  settle(bytes ? State::resident : State::missing);
  resident_bytes_ -= p.facts.bytes;
  p.is_stored = p.is_stored && bytes;
  if (!bytes) return;
  p.facts.bytes = std::max<std::uint64_t>(*bytes, 1);
  resident_bytes_ += p.facts.bytes;
  const bool is_first = from == State::stored && !p.has_left;
  ++(is_first ? counts_.fetched : counts_.reloaded)[index_of(kind)];
  counts_.reloaded_bytes += is_first ? 0 : p.facts.bytes;
  if (from != State::stored) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fetch_seconds_per_byte_ += 0.1 * (seconds / static_cast<double>(p.facts.bytes) - fetch_seconds_per_byte_);
}

void Residency::expect(PieceKind kind, std::size_t tile) {
  if (!spill_) return;
  std::optional<SpillFile::Extent> extent;
  {
    const std::lock_guard lock(mutex_);
    const Piece& p = piece(kind, tile);
    if (p.state == State::spilled) extent = p.copy;
  }
  if (extent) spill_->expect(*extent);
}

bool Residency::is_worth_room(PieceKind kind, std::size_t tile, std::uint64_t bytes) {
  if (!is_limited()) return true;
  const std::lock_guard lock(mutex_);
  const Piece& p = piece(kind, tile);
  if (p.state != State::missing) return false;
  PieceFacts facts = p.facts;
  if (p.rebuild_seconds == 0) facts.bytes = std::max<std::uint64_t>(bytes, 1);  // never seen
  if (fits(facts.bytes)) return true;
  facts.return_seconds = return_seconds(p);
  if (facts.last_use == change_) facts.last_use = p.use_before;
  const double weight = eviction_weight(options_.policy, facts, change_);
  if (candidates_.empty()) list_candidates();
  return !candidates_.empty() && candidates_.back().weight < weight;
}

void Residency::release(PieceKind kind, std::size_t tile) {
  const std::lock_guard lock(mutex_);
  --piece(kind, tile).pins;
}

void Residency::touch(PieceKind kind, std::size_t tile) {
  PieceFacts& facts = piece(kind, tile).facts;
  if (facts.last_use == change_ && facts.uses > 0) return;
  piece(kind, tile).use_before = std::exchange(facts.last_use, change_);
  facts.gdsf_inflation = gdsf_inflation_;
  ++facts.uses;
  if (options_.logs_accesses) log_use(kind_name(kind), tile, facts, return_seconds(piece(kind, tile)));
}

void Residency::note_use_of_other(std::string_view kind, std::size_t number, std::uint64_t bytes, double seconds) {
  if (!options_.logs_accesses) return;
  const std::lock_guard lock(mutex_);
  PieceFacts facts;
  facts.bytes = std::max<std::uint64_t>(bytes, 1);
  log_use(kind, number, facts, seconds);
}

void Residency::log_use(std::string_view kind, std::size_t tile, const PieceFacts& facts, double seconds) {
  char line[160];
  std::snprintf(line, sizeof line, "%llu %s %zu %llu %.6g %.6g\n", static_cast<unsigned long long>(change_),
                std::string(kind).c_str(), tile, static_cast<unsigned long long>(facts.bytes), seconds,
                facts.surface_area);
  log_ += line;
}

void Residency::forget(PieceKind kind, std::size_t tile) {
  const std::lock_guard lock(mutex_);
  Piece& p = piece(kind, tile);
  require(kinds_[index_of(kind)].handler.may_be_missing, "only what can be worked out again is forgotten");
  if (p.state == State::resident) {
    resident_bytes_ -= p.facts.bytes;
    kinds_[index_of(kind)].handler.drop(tile);
  }
  free_copy(p);
  p.is_stored = false;
  p.state = State::missing;
}

PieceCounts Residency::take_counts() {
  const std::lock_guard lock(mutex_);
  return std::exchange(counts_, {});
}

std::uint64_t Residency::known_bytes() const { return resident_bytes_ + (others_bytes_ ? others_bytes_() : 0); }

bool Residency::fits(std::uint64_t bytes) const {
  return outside_bytes_ + known_bytes() + bytes <= *options_.memory_bytes;
}

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
  if (needed > limit + limit / kSlack)
    throw ResourceError("--memory", "this replay needs at least " + megabytes(needed));
}

bool Residency::make_room(std::uint64_t bytes) {
  if (!is_limited()) return true;
  const std::lock_guard lock(mutex_);
  return make_room_locked(bytes);
}

bool Residency::make_room_locked(std::uint64_t bytes) {
  if (!is_limited()) return true;
  measure_outside();
  for (bool is_listed = false; !fits(bytes);) {
    if (candidates_.empty()) {
      if (std::exchange(is_listed, true)) return false;
      list_candidates();
      continue;
    }
    const Candidate next = candidates_.back();
    candidates_.pop_back();
    if (options_.policy == EvictionPolicy::gdsf) gdsf_inflation_ = std::max(gdsf_inflation_, next.weight);
    if (next.victim < victims_.size())
      evict_other(victims_[next.victim]);
    else
      evict(next.kind, next.tile);
  }
  return true;
}

void Residency::list_candidates() {
  candidates_.clear();
  victims_.clear();
  for (std::size_t k = 0; k < kPieceKinds; ++k) {
    if (!spill_ && !kinds_[k].handler.may_be_missing) continue;  // nowhere to go
    for (std::size_t tile = 0; tile < kinds_[k].pieces.size(); ++tile) {
      Piece& p = kinds_[k].pieces[tile];
      if (p.state != State::resident || p.pins > 0) continue;
      p.facts.return_seconds = return_seconds(p);
      candidates_.push_back(
          {eviction_weight(options_.policy, p.facts, change_), static_cast<PieceKind>(k), tile, ~std::size_t{0}});
    }
  }
  if (list_others_) list_others_(victims_);
  for (std::size_t i = 0; i < victims_.size(); ++i)
    candidates_.push_back({victims_[i].weight, PieceKind::ray_trees, 0, i});
  std::ranges::sort(candidates_, std::greater(), &Candidate::weight);
}

/// From disk, if it may go there; what has no other way to come back is priced like that, too.
double Residency::return_seconds(const Piece& p) const {
  if (p.is_stored) return static_cast<double>(p.facts.bytes) * fetch_seconds_per_byte_;
  const double by_disk = static_cast<double>(p.facts.bytes) * seconds_per_byte_ * (p.copy ? 1 : 2);
  return spill_ || p.rebuild_seconds == 0 ? by_disk : p.rebuild_seconds;
}

void Residency::evict_other(const Victim& victim) {
  const std::uint64_t before = others_bytes_();
  counts_.others_evicted += victim.drop();
  counts_.evicted_bytes += before - std::min(before, others_bytes_());
}

bool Residency::evict(PieceKind kind, std::size_t tile) {
  Piece& p = piece(kind, tile);
  const PieceHandler& handler = kinds_[index_of(kind)].handler;
  if (p.state != State::resident || p.pins > 0) return false;
  if (!p.copy && !p.is_stored && spill_) {
    const auto start = std::chrono::steady_clock::now();
    p.copy = spill_->write(handler.pack(tile));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    seconds_per_byte_ += 0.1 * (seconds / static_cast<double>(p.facts.bytes) - seconds_per_byte_);
  }
  if (!p.copy && !p.is_stored && !handler.may_be_missing) return false;
  handler.drop(tile);
  p.state = p.copy ? State::spilled : p.is_stored ? State::stored : State::missing;
  p.has_left = true;
  resident_bytes_ -= p.facts.bytes;
  ++counts_.evicted[index_of(kind)];
  counts_.evicted_bytes += p.facts.bytes;
  return true;
}

}  // namespace relook
