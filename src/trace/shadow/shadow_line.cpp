#include "trace/shadow/shadow_line.h"

#include <algorithm>

namespace relook {

bool ShadowLine::start(std::span<const Crossing> steady, std::span<const Crossing> transparent,
                       std::span<const std::uint32_t> counters) {
  surfaces_.assign(steady.begin(), steady.end());
  for (const Crossing& surface : transparent)
    surfaces_.insert(surfaces_.begin() + static_cast<std::ptrdiff_t>(interval_of(surface)), surface);
  counters_.clear();
  for (const std::uint32_t word : counters) counters_.push_back(ShadowCounter::from_word(word, bits_));
  if (counters.empty()) counters_.assign(surfaces_.size() + 1, ShadowCounter::of(0, bits_));
  return counters_.size() == surfaces_.size() + 1;
}

bool ShadowLine::exchange(const SelectionCrossings& then, const SelectionCrossings& now) {
  count(then.opaque, removed_);
  const bool same_surfaces = then.transparent.empty() && now.transparent.empty();
  if (same_surfaces)
    count(now.opaque, added_);  // at once: how many of an interval have changed places does not matter
  else
    added_.assign(counters_.size(), 0);
  for (std::size_t i = 0; i < counters_.size(); ++i)
    if (!change(i, removed_[i], added_[i])) return false;
  if (same_surfaces) return true;
  for (const Crossing& surface : then.transparent)
    if (!take_out(surface)) return false;
  for (const Crossing& surface : now.transparent)
    if (!put_in(surface)) return false;
  count(now.opaque, added_);
  for (std::size_t i = 0; i < counters_.size(); ++i) counters_[i] = counters_[i].added(added_[i]);
  return true;
}

bool ShadowLine::is_blocked() const { return std::ranges::any_of(counters_, &ShadowCounter::is_blocked); }

std::span<const std::uint32_t> ShadowLine::entry() {
  entry_.assign(1, static_cast<std::uint32_t>(surfaces_.size()));
  for (const Crossing& surface : surfaces_) entry_.push_back(surface.object.index());
  for (const ShadowCounter& counter : counters_) entry_.push_back(counter.word());
  return entry_;
}

std::size_t ShadowLine::interval_of(const Crossing& crossing) const {
  const auto after = std::ranges::upper_bound(surfaces_, place_on_segment(crossing), {}, place_on_segment);
  return static_cast<std::size_t>(after - surfaces_.begin());
}

void ShadowLine::count(std::span<const Crossing> opaque, std::vector<std::uint32_t>& by_interval) {
  by_interval.assign(counters_.size(), 0);
  distinct_.clear();
  for (const Crossing& crossing : opaque) {
    const std::pair place(interval_of(crossing), crossing.object);
    if (std::ranges::find(distinct_, place) != distinct_.end()) continue;
    distinct_.push_back(place);
    ++by_interval[place.first];
  }
}

bool ShadowLine::change(std::size_t interval, std::uint32_t removed, std::uint32_t added) {
  ShadowCounter& counter = counters_[interval];
  const std::optional<ShadowCounter> next =
      added >= removed ? counter.added(added - removed) : counter.removed(removed - added);
  if (next) counter = *next;
  return next.has_value();
}

/// An object on both sides of the surface is one object without it: the numbers add up only if one of them is 0.
bool ShadowLine::take_out(const Crossing& surface) {
  const auto found = std::ranges::find(surfaces_, surface);
  if (found == surfaces_.end()) return false;
  const auto i = found - surfaces_.begin();
  const auto before = counters_.begin() + i, after = std::next(before);
  if (before->is_blocked() && after->is_blocked() && !before->overflows() && !after->overflows()) return false;
  if (!before->is_blocked() || after->overflows()) *before = *after;
  counters_.erase(after);
  surfaces_.erase(found);
  return true;
}

bool ShadowLine::put_in(const Crossing& surface) {
  const auto i = static_cast<std::ptrdiff_t>(interval_of(surface));
  if (counters_[static_cast<std::size_t>(i)].is_blocked()) return false;
  counters_.insert(counters_.begin() + i, ShadowCounter::of(0, bits_));
  surfaces_.insert(surfaces_.begin() + i, surface);
  return true;
}

}  // namespace relook
