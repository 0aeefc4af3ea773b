// The branches that lead from the eye to a node of a ray tree, as one number: what sections of tunnels are told apart
// by. The numbers are on disk (cache/FORMAT.md).
#pragma once
#include <cstdint>

#include "trace/tree/branch.h"

namespace relook {

/// 0 the eye, 1 the hit of the primary ray, 4 h + 1 + branch a child of h; where colours part, the three refracted rays
/// share the number of one, and a diffuse ray has that of a reflection. Histories that would leave 28 bits are their parent's: such a section encloses all that is
/// below it.
class History {
 public:
  constexpr History() = default;  // the eye
  [[nodiscard]] static constexpr History eye() { return History(); }
  [[nodiscard]] static constexpr History primary() { return History(1); }
  [[nodiscard]] static constexpr History of_number(std::uint32_t number) { return History(number); }

  [[nodiscard]] constexpr History child(Branch branch) const {
    const Branch kind = BranchSet::parted().has(branch) ? Branch::refraction
                        : branch == Branch::diffuse     ? Branch::reflection
                                                        : branch;
    const History below(4 * number_ + 1 + static_cast<std::uint32_t>(kind));
    return below.number_ < kEnd ? below : *this;
  }
  /// Requires: not the eye.
  [[nodiscard]] constexpr History parent() const { return History((number_ - 1) / 4); }
  [[nodiscard]] constexpr bool is_eye() const { return number_ == 0; }
  /// Is it that of all its children, too?
  [[nodiscard]] constexpr bool is_folded() const { return child(Branch::transparency) == *this; }
  [[nodiscard]] constexpr std::uint32_t number() const { return number_; }
  friend constexpr auto operator<=>(History, History) = default;

 private:
  static constexpr std::uint32_t kEnd = 1U << 28;
  constexpr explicit History(std::uint32_t number) : number_(number) {}
  std::uint32_t number_ = 0;
};
static_assert(sizeof(History) == sizeof(std::uint32_t));
static_assert(History::primary().parent().is_eye() && History::eye().child(Branch::reflection) == History::primary());

}  // namespace relook
