// Walks the words of a ray path node by node, in preorder. Requires a sound path (broken_invariants() is empty).
#pragma once
#include <bit>
#include <cstdint>
#include <span>

#include "base/id.h"
#include "trace/ray_path.h"

namespace relook {

inline constexpr std::uint32_t kInsideFlag = 1U << 4;
inline constexpr std::uint32_t kCutShift = 8;

[[nodiscard]] inline ShadowState shadow_state(std::span<const std::uint32_t> light_words, std::size_t light) {
  return static_cast<ShadowState>((light_words[light / 16] >> (2 * (light % 16))) & 3U);
}

/// One node of a path.
struct PathNode {
  std::uint32_t object_word = PathTable::kMissWord;
  std::uint32_t flags = 0;
  std::span<const std::uint32_t> lights;   // packed states
  std::span<const std::uint32_t> filters;  // per filtered light: count, objects
  std::uint32_t filter_hits = 0;           // objects in `filters`

  [[nodiscard]] bool is_miss() const { return object_word == PathTable::kMissWord; }
  [[nodiscard]] ObjectId object() const { return ObjectId(object_word); }
  [[nodiscard]] bool has_child(Branch branch) const { return (flags >> static_cast<unsigned>(branch) & 1U) != 0; }
  [[nodiscard]] unsigned children() const { return static_cast<unsigned>(std::popcount(flags & 0xFU)); }
  [[nodiscard]] bool inside() const { return (flags & kInsideFlag) != 0; }
};

class PathCursor {
 public:
  PathCursor(std::span<const std::uint32_t> words, std::size_t lights)
      : words_(words), light_count_(lights), light_words_((lights + 15) / 16) {}

  [[nodiscard]] bool at_end() const { return position_ == words_.size(); }

  PathNode next() {
    PathNode node;
    node.object_word = words_[position_++];
    if (node.is_miss()) return node;
    node.flags = words_[position_++];
    node.lights = words_.subspan(position_, light_words_);
    position_ += light_words_;
    const std::size_t start = position_;
    for (std::size_t light = 0; light < light_count_; ++light) {
      if (shadow_state(node.lights, light) != ShadowState::filtered) continue;
      const std::uint32_t count = words_[position_];
      node.filter_hits += count;
      position_ += 1 + count;
    }
    node.filters = words_.subspan(start, position_ - start);
    return node;
  }

 private:
  std::span<const std::uint32_t> words_;
  std::size_t position_ = 0;
  std::size_t light_count_, light_words_;
};

}  // namespace relook
