// The words of a ray path that hold more than one thing: how a node's flags and the states of its lights are packed, as
// they are on disk (ray_path.h says in what order words follow each other). Here alone is it known which bit is which.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "trace/tree/branch.h"

namespace relook {

/// What stands between a hit and one light. How many opaque blockers is counted apart: see shadow_counter.h. The
/// numbers are on disk.
enum class ShadowState : std::uint8_t {
  facing_away = 0,  // the light is below the smooth surface, or none is gathered here: no segment
  open = 1,         // nothing in between
  filtered = 2,     // transparent blockers only: they follow in the path, from the hit towards the light
  blocked = 3,      // at least one opaque blocker
};

/// What a path says of a hit beside its object. Bits 0..3: branches 0..3 are spawned; 4: on the inner side; 5..7:
/// branches 4..6 are spawned; 8..15: branches that the Fresnel cut-off removed; 16: branch 7 is spawned.
class NodeFlags {
 public:
  constexpr NodeFlags() = default;
  constexpr NodeFlags(BranchSet branches, bool inside, BranchSet cut)
      : word_((branches.bits() & kLowBranches) | static_cast<std::uint32_t>(branches.bits() & kHighBranches) << 1 |
              (branches.has(Branch::diffuse) ? kDiffuse : 0U) | (inside ? kInside : 0U) |
              static_cast<std::uint32_t>(cut.bits()) << kCutShift) {}
  [[nodiscard]] static constexpr NodeFlags of_word(std::uint32_t word) {
    NodeFlags flags;
    flags.word_ = word;
    return flags;
  }
  [[nodiscard]] constexpr std::uint32_t word() const { return word_; }
  /// Are all bits known ones?
  [[nodiscard]] constexpr bool is_sound() const { return word_ < 2 * kDiffuse; }

  [[nodiscard]] constexpr BranchSet branches() const {
    return BranchSet::of_bits(static_cast<std::uint8_t>((word_ & kLowBranches) | (word_ >> 1 & kHighBranches) |
                                                        (word_ & kDiffuse) >> kDiffuseShift));
  }
  [[nodiscard]] constexpr bool inside() const { return (word_ & kInside) != 0; }
  /// Requires: is_sound().
  [[nodiscard]] constexpr BranchSet cut() const {
    return BranchSet::of_bits(static_cast<std::uint8_t>(word_ >> kCutShift & BranchSet::all().bits()));
  }
  friend constexpr bool operator==(NodeFlags, NodeFlags) = default;

 private:
  static constexpr std::uint32_t kLowBranches = 0xFU, kHighBranches = BranchSet::parted().bits(), kInside = 1U << 4,
                                 kDiffuse = 1U << 16;
  static constexpr unsigned kCutShift = 8, kDiffuseShift = 9;  // from its bit to that of BranchSet
  std::uint32_t word_ = 0;
};
static_assert(sizeof(NodeFlags) == sizeof(std::uint32_t));
static_assert(NodeFlags(BranchSet::all(), false, {}).branches() == BranchSet::all());
static_assert(!NodeFlags(BranchSet::all(), false, BranchSet::all()).inside());
static_assert(NodeFlags({}, true, BranchSet::all()).is_sound() && NodeFlags({}, true, {}).branches().empty());

/// The states of 16 lights that follow each other in the light order, two bits each.
class LightStates {
 public:
  static constexpr std::size_t kLights = 16;
  /// Words of that many lights.
  [[nodiscard]] static constexpr std::size_t words_of(std::size_t lights) { return (lights + kLights - 1) / kLights; }

  constexpr explicit LightStates(std::uint32_t word) : word_(word) {}
  [[nodiscard]] constexpr std::uint32_t word() const { return word_; }
  /// `place`: in the word.
  [[nodiscard]] constexpr ShadowState state(std::size_t place) const {
    return static_cast<ShadowState>(word_ >> (2 * place) & 3U);
  }
  /// Requires: the state there is the first one so far.
  constexpr void set(std::size_t place, ShadowState state) {
    word_ |= static_cast<std::uint32_t>(state) << (2 * place);
  }

 private:
  std::uint32_t word_;
};
static_assert(sizeof(LightStates) == sizeof(std::uint32_t));

/// The state of a light of a node whose states these words are.
[[nodiscard]] inline ShadowState shadow_state(std::span<const std::uint32_t> light_words, std::size_t light) {
  return LightStates(light_words[light / LightStates::kLights]).state(light % LightStates::kLights);
}

/// Do words follow the states for a light in this state?
[[nodiscard]] inline bool has_entry(ShadowState state, std::uint32_t shadow_bits) {
  return state == ShadowState::filtered || (state == ShadowState::blocked && shadow_bits > 0);
}
/// Words of the entry of a light with `count` transparent surfaces.
[[nodiscard]] inline std::size_t entry_size(std::size_t count, ShadowState state) {
  return 1 + count + (state == ShadowState::blocked ? count + 1 : 0);
}

}  // namespace relook
