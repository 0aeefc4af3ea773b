// Walks the words of a ray path node by node, in preorder. Requires a sound path (broken_invariants() is empty).
#pragma once
#include <cstdint>
#include <span>

#include "base/id.h"
#include "trace/tree/ray_path.h"

namespace relook {

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
  ObjectId object;  // none: the ray left the scene
  NodeFlags flags;
  std::span<const std::uint32_t> lights;   // LightStates
  std::span<const std::uint32_t> entries;  // of the lights, for an EntryReader
  std::uint32_t filter_hits = 0;           // transparent surfaces of all filtered lights
  std::uint32_t shadow_segments = 0;       // to lights that the surface faces

  [[nodiscard]] bool is_miss() const { return object.is_none(); }
  [[nodiscard]] BranchSet branches() const { return flags.branches(); }
  [[nodiscard]] bool has_child(Branch branch) const { return branches().has(branch); }
  [[nodiscard]] unsigned children() const { return branches().size(); }
  /// The ray that leads here, and those to lights.
  [[nodiscard]] std::uint32_t segments() const { return 1 + shadow_segments; }
  [[nodiscard]] bool inside() const { return flags.inside(); }
};

class PathCursor {
 public:
  PathCursor(std::span<const std::uint32_t> words, const PathLayout& layout)
      : words_(words), layout_(layout), light_words_(LightStates::words_of(layout.lights)) {}

  [[nodiscard]] bool at_end() const { return position_ == words_.size(); }
  /// Where the next node starts.
  [[nodiscard]] std::size_t position() const { return position_; }

  PathNode next() {
    PathNode node;
    node.object = ObjectId(words_[position_++]);
    if (node.is_miss()) return node;
    node.flags = NodeFlags::of_word(words_[position_++]);
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
