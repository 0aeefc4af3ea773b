// A shadow segment with all that is known to stand on it: transparent surfaces in their order, and the number of opaque
// objects in each interval between them (paper 4.2). What the selection did there before is taken out, what it does now
// is put in, and the counters follow without a ray where they can.
// Invariant: the same line as one counted afresh, since equal numbers are equal counters.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "trace/shadow/shadow_counter.h"
#include "trace/tracer.h"

namespace relook {

/// What of the selection a segment crosses, each in the order of the segment.
struct SelectionCrossings {
  std::vector<Crossing> opaque, transparent;
  [[nodiscard]] bool empty() const { return opaque.empty() && transparent.empty(); }
  void clear() {
    opaque.clear();
    transparent.clear();
  }
};

class ShadowLine {
 public:
  explicit ShadowLine(std::uint32_t bits) : bits_(bits) {}

  /// `steady`: the transparent surfaces beside the selection's, in order. `counters`: one an interval between these and
  /// the selection's `transparent` surfaces; none: nothing opaque is there. False if their numbers do not fit.
  [[nodiscard]] bool start(std::span<const Crossing> steady, std::span<const Crossing> transparent,
                           std::span<const std::uint32_t> counters);

  /// The selection was `then`, whose transparent surfaces start() knew, and is `now`. False if the segment must be
  /// counted afresh: too many blockers were there to tell how many are left, or surfaces have come or gone among
  /// blockers that do not tell on which side of them they stand.
  [[nodiscard]] bool exchange(const SelectionCrossings& then, const SelectionCrossings& now);

  [[nodiscard]] std::span<const Crossing> surfaces() const { return surfaces_; }
  [[nodiscard]] bool is_blocked() const;
  /// The entry of a blocked light, as in paths. Valid until the next call of anything here.
  [[nodiscard]] std::span<const std::uint32_t> entry();

 private:
  [[nodiscard]] std::size_t interval_of(const Crossing& crossing) const;
  /// Distinct objects by interval.
  void count(std::span<const Crossing> opaque, std::vector<std::uint32_t>& by_interval);
  [[nodiscard]] bool change(std::size_t interval, std::uint32_t removed, std::uint32_t added);
  [[nodiscard]] bool take_out(const Crossing& surface);
  [[nodiscard]] bool put_in(const Crossing& surface);

  std::uint32_t bits_;
  std::vector<Crossing> surfaces_;
  std::vector<ShadowCounter> counters_;  // [surfaces + 1]
  std::vector<std::uint32_t> removed_, added_, entry_;
  std::vector<std::pair<std::size_t, ObjectId>> distinct_;
};

}  // namespace relook
