// Ray paths (paper 2.2): the ordered tree of objects that a sample's rays meet, with branch kinds and shadow states,
// interned so that equal paths share one id. Hits (PDI) are not part of it: see ray_tree.h.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/id.h"

namespace relook {

/// How a ray left its parent. The numbers are on disk, but for that of the primary ray, and never change. The last
/// three stand for `refraction` where colours part (KHR_materials_dispersion).
enum class Branch : std::uint8_t {
  reflection = 0,
  coat = 1,
  refraction = 2,
  transparency = 3,
  refracted_red = 4,
  refracted_green = 5,
  refracted_blue = 6,
  primary = 7
};
inline constexpr std::size_t kBranches = 7;  // those that a hit can spawn
/// Sets of branches: a bit each.
inline constexpr std::uint8_t kAllBranches = 0x7F, kPartedBranches = 0x70;

/// What of the light that comes back along a ray counts: all of it, or one channel.
enum class Channel : std::uint8_t { all, red, green, blue };
inline constexpr std::array<Channel, 3> kChannels{Channel::red, Channel::green, Channel::blue};
/// How a ray of this channel alone is refracted where colours part.
[[nodiscard]] constexpr Branch refracted(Channel channel) {
  constexpr std::array<Branch, 4> kBranchOf{Branch::refraction, Branch::refracted_red, Branch::refracted_green,
                                            Branch::refracted_blue};
  return kBranchOf[static_cast<std::size_t>(channel)];
}
/// The channel of a ray whose parent's is `parent`.
[[nodiscard]] constexpr Channel channel_of(Branch branch, Channel parent) {
  for (const Channel channel : kChannels)
    if (branch == refracted(channel)) return channel;
  return parent;
}

/// What stands between a hit and one light. How many opaque blockers is counted apart: see shadow_counter.h.
enum class ShadowState : std::uint8_t {
  facing_away = 0,  // the light is below the geometric surface: no segment
  open = 1,         // nothing in between
  filtered = 2,     // transparent blockers only: they follow in the path, from the hit towards the light
  blocked = 3,      // at least one opaque blocker
};

/// What the form of a path depends on, the same for all paths of an image.
struct PathLayout {
  std::size_t lights = 0;         // living lights of the scene
  std::uint32_t shadow_bits = 0;  // of a shadow counter; 0: none are kept, `blocked` says it all
};

/// Interned paths. A path is a sequence of words, nodes in preorder, children in the order of Branch:
///   node     object index (kMissWord: the ray left the scene)
///            branch mask of spawned rays (branches 0..3 in bits 0..3, 4..6 in bits 5..7) | inside flag (bit 4) |
///            Fresnel-cut mask (bits 8..14)                                                                   [hits
///            only]
///   lights   two bits per living light in the scene's light order, packed 16 to a word                      [hits
///            only]
///   entries  in light order [hits only]:
///            for every `filtered` light: count, then that many object indices
///            for every `blocked` light if shadows are counted: count k of transparent surfaces on the segment, their k
///            object indices from the hit towards the light, and k + 1 shadow counters (one a word): distinct opaque
///            objects of each interval between them. No hits are stored for these.
/// Invariant: ids are dense, in order of first insertion; equal sequences have equal ids.
class PathTable {
 public:
  static constexpr std::uint32_t kMissWord = 0xFFFFFFFFU;

  PathId intern(std::span<const std::uint32_t> words);
  [[nodiscard]] std::span<const std::uint32_t> words(PathId id) const {
    return {words_.data() + offsets_[id.index()], offsets_[id.index() + 1] - offsets_[id.index()]};
  }
  [[nodiscard]] std::size_t size() const { return offsets_.size() - 1; }
  [[nodiscard]] std::size_t bytes() const;

  // For the cache: the whole table as two columns.
  [[nodiscard]] std::span<const std::uint32_t> all_words() const { return words_; }
  [[nodiscard]] std::span<const std::uint64_t> all_offsets() const { return offsets_; }
  /// Rebuilds a table from its columns. Requires: offsets start at 0, increase, end at words.size().
  static PathTable from_columns(std::vector<std::uint32_t> words, std::vector<std::uint64_t> offsets);

 private:
  [[nodiscard]] std::uint64_t hash_of(std::span<const std::uint32_t> words) const;

  std::vector<std::uint32_t> words_;
  std::vector<std::uint64_t> offsets_{0};               // [size() + 1]
  std::unordered_multimap<std::uint64_t, PathId> ids_;  // by hash of the words
};

/// Number of hits (nodes and filters) that a ray tree with this path stores; and sentences about what is malformed for
/// `objects` objects (empty: sound). A sound path can be walked without further checks.
[[nodiscard]] std::size_t hit_count(std::span<const std::uint32_t> words, const PathLayout& layout);
[[nodiscard]] std::vector<std::string> broken_invariants(std::span<const std::uint32_t> words, std::size_t objects,
                                                         const PathLayout& layout);

}  // namespace relook
