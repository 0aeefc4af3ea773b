// Walks the words of a ray path node by node, in preorder. Requires a sound path (broken_invariants() is empty).
#pragma once
#include <bit>
#include <cstdint>
#include <span>

#include "base/id.h"
#include "trace/tree/ray_path.h"

namespace relook {

inline constexpr std::uint32_t kInsideFlag = 1U << 4;
inline constexpr std::uint32_t kCutShift = 8;
inline constexpr std::uint32_t kKnownFlags = (std::uint32_t{kAllBranches} << kCutShift) | 0xFFU;

/// Branches as the flags of a node hold them, and back.
[[nodiscard]] constexpr std::uint32_t branch_flags(std::uint8_t mask) {
  return (mask & 0xFU) | (mask & std::uint32_t{kPartedBranches}) << 1;
}
[[nodiscard]] constexpr std::uint8_t branches_of(std::uint32_t flags) {
  return static_cast<std::uint8_t>((flags & 0xFU) | (flags >> 1 & kPartedBranches));
}
static_assert(branches_of(branch_flags(kAllBranches)) == kAllBranches);
static_assert((branch_flags(kAllBranches) & kInsideFlag) == 0);

[[nodiscard]] inline ShadowState shadow_state(std::span<const std::uint32_t> light_words, std::size_t light) {
  return static_cast<ShadowState>((light_words[light / 16] >> (2 * (light % 16))) & 3U);
}

/// Do words follow the states for a light in this state?
[[nodiscard]] inline bool has_entry(ShadowState state, std::uint32_t shadow_bits) {
  return state == ShadowState::filtered || (state == ShadowState::blocked && shadow_bits > 0);
}
/// Words of the entry of a light with `count` transparent surfaces.
[[nodiscard]] inline std::size_t entry_size(std::size_t count, ShadowState state) {
  return 1 + count + (state == ShadowState::blocked ? count + 1 : 0);
}

/// What a path holds of one light.
struct LightEntry {
  std::span<const std::uint32_t> words;     // all of it; empty: has_entry() is false
  std::span<const std::uint32_t> objects;   // transparent surfaces from the hit towards the light
  std::span<const std::uint32_t> counters;  // of a blocked light: one an interval
};

/// Reads the entries of a node, light by light.
class EntryReader {
 public:
  EntryReader(std::span<const std::uint32_t> entries, std::uint32_t shadow_bits)
      : words_(entries), shadow_bits_(shadow_bits) {}

  /// The entry of the next light, whose state is `state`.
  LightEntry next(ShadowState state) {
    if (!has_entry(state, shadow_bits_)) return {};
    const std::size_t count = words_[0], size = entry_size(count, state);
    const LightEntry entry{words_.first(size), words_.subspan(1, count), words_.subspan(1 + count, size - 1 - count)};
    words_ = words_.subspan(size);
    return entry;
  }

 private:
  std::span<const std::uint32_t> words_;
  std::uint32_t shadow_bits_;
};

/// One node of a path.
struct PathNode {
  std::uint32_t object_word = PathTable::kMissWord;
  std::uint32_t flags = 0;
  std::span<const std::uint32_t> lights;   // packed states
  std::span<const std::uint32_t> entries;  // of the lights, for an EntryReader
  std::uint32_t filter_hits = 0;           // transparent surfaces of all filtered lights
  std::uint32_t shadow_segments = 0;       // to lights that the surface faces

  [[nodiscard]] bool is_miss() const { return object_word == PathTable::kMissWord; }
  [[nodiscard]] ObjectId object() const { return ObjectId(object_word); }
  [[nodiscard]] std::uint8_t branches() const { return branches_of(flags); }
  [[nodiscard]] bool has_child(Branch branch) const { return (branches() >> static_cast<unsigned>(branch) & 1U) != 0; }
  [[nodiscard]] unsigned children() const { return static_cast<unsigned>(std::popcount(branches())); }
  /// The ray that leads here, and those to lights.
  [[nodiscard]] std::uint32_t segments() const { return 1 + shadow_segments; }
  [[nodiscard]] bool inside() const { return (flags & kInsideFlag) != 0; }
};

class PathCursor {
 public:
  PathCursor(std::span<const std::uint32_t> words, const PathLayout& layout)
      : words_(words), layout_(layout), light_words_((layout.lights + 15) / 16) {}

  [[nodiscard]] bool at_end() const { return position_ == words_.size(); }
  /// Where the next node starts.
  [[nodiscard]] std::size_t position() const { return position_; }

  PathNode next() {
    PathNode node;
    node.object_word = words_[position_++];
    if (node.is_miss()) return node;
    node.flags = words_[position_++];
    node.lights = words_.subspan(position_, light_words_);
    position_ += light_words_;
    const std::size_t start = position_;
    for (std::size_t light = 0; light < layout_.lights; ++light) {
      const ShadowState state = shadow_state(node.lights, light);
      if (state != ShadowState::facing_away) ++node.shadow_segments;
      if (!has_entry(state, layout_.shadow_bits)) continue;
      const std::uint32_t count = words_[position_];
      if (state == ShadowState::filtered) node.filter_hits += count;
      position_ += entry_size(count, state);
    }
    node.entries = words_.subspan(start, position_ - start);
    return node;
  }

 private:
  std::span<const std::uint32_t> words_;
  std::size_t position_ = 0;
  PathLayout layout_;
  std::size_t light_words_;
};

}  // namespace relook
