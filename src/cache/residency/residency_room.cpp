// Room for what is about to be resident: what leaves for it, in the order of the policy's weights.
#include <algorithm>
#include <functional>
#include <utility>

#include "cache/residency/residency.h"

namespace relook {

std::uint64_t Residency::known_bytes() const { return resident_bytes_ + (others_bytes_ ? others_bytes_() : 0); }

bool Residency::fits(std::uint64_t bytes) const {
  return outside_bytes_ + known_bytes() + bytes <= *options_.memory_bytes;
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
      p.facts.return_seconds = return_seconds(p, kinds_[k].handler.is_derived);
      candidates_.push_back(
          {eviction_weight(options_.policy, p.facts, change_), static_cast<PieceKind>(k), tile, ~std::size_t{0}});
    }
  }
  if (list_others_) list_others_(victims_);
  for (std::size_t i = 0; i < victims_.size(); ++i)
    candidates_.push_back({victims_[i].weight, PieceKind::ray_trees, 0, i});
  std::ranges::sort(candidates_, std::greater(), &Candidate::weight);
}

/// The seconds that it takes to have the piece back: from the cache, if it is stored there; from the spill file, if
/// there is one or if nothing says how long it takes to work the piece out again; otherwise to work it out again.
double Residency::return_seconds(const Piece& p, bool is_derived) const {
  if (p.is_stored) return static_cast<double>(p.facts.bytes) * fetch_seconds_per_byte_;
  if (is_derived) return p.rebuild_seconds;
  const double by_disk = static_cast<double>(p.facts.bytes) * seconds_per_byte_ * (p.copy ? 1 : 2);
  return spill_ || p.rebuild_seconds == 0 ? by_disk : p.rebuild_seconds;
}

void Residency::evict_other(const Victim& victim) {
  const std::uint64_t before = others_bytes_();
  counts_.others_evicted += victim.drop();
  counts_.evicted_bytes += before - std::min(before, others_bytes_());
}

bool Residency::is_worth_room(PieceKind kind, std::size_t tile, std::uint64_t bytes) {
  if (!is_limited()) return true;
  const std::lock_guard lock(mutex_);
  const Piece& p = piece(kind, tile);
  if (p.state != State::missing) return false;
  PieceFacts facts = p.facts;
  if (p.rebuild_seconds == 0) facts.bytes = std::max<std::uint64_t>(bytes, 1);  // never seen
  if (fits(facts.bytes)) return true;
  facts.return_seconds = return_seconds(p, kinds_[index_of(kind)].handler.is_derived);
  if (facts.last_use == change_) facts.last_use = p.use_before;
  const double weight = eviction_weight(options_.policy, facts, change_);
  if (candidates_.empty()) list_candidates();
  return !candidates_.empty() && candidates_.back().weight < weight;
}

}  // namespace relook
