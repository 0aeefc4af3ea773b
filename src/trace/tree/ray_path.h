// Ray paths (paper 2.2): the ordered tree of objects that a sample's rays meet, with branch kinds and shadow states,
// interned so that equal paths share one id. Hits (PDI) are not part of it: see ray_tree.h.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/id.h"
#include "trace/tree/path_words.h"

namespace relook {

/// What the form of a path depends on, the same for all paths of an image.
struct PathLayout {
  std::size_t lights = 0;         // living lights of the scene
  std::uint32_t shadow_bits = 0;  // of a shadow counter; 0: none are kept, `blocked` says it all
};

/// Interned paths. A path is a sequence of words, nodes in preorder, children in the order of Branch:
///   node     object index (kMissWord: the ray left the scene), then NodeFlags [hits only]
///   lights   LightStates of the living lights in the scene's light order     [hits only]
///   entries  in light order [hits only]:
///            for every `filtered` light: count, then that many object indices
///            for every `blocked` light if shadows are counted: count k of transparent surfaces on the segment, their k
///            object indices from the hit towards the light, and k + 1 shadow counters (one a word): distinct opaque
///            objects of each interval between them. No hits are stored for these.
/// Invariant: ids are dense, in order of first insertion; equal sequences have equal ids.
class PathTable {
 public:
  static constexpr std::uint32_t kMissWord = ObjectId::none().index();

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
  /// Where a path stands in the index, or an empty place for it.
  struct Place {
    PathId id;  // none: empty
    std::uint32_t hash = 0;
  };
  [[nodiscard]] Place& place_of(std::span<const std::uint32_t> path, std::uint32_t hash);
  /// Makes room for that many paths.
  void reserve(std::size_t paths);

  std::vector<std::uint32_t> words_;
  std::vector<std::uint64_t> offsets_{0};               // [size() + 1]
  std::vector<Place> index_;  // by hash of the words, linear probing; a power of two, at most half full
};

/// Number of hits (nodes and filters) that a ray tree with this path stores; and sentences about what is malformed for
/// `objects` objects (empty: sound). A sound path can be walked without further checks.
[[nodiscard]] std::size_t hit_count(std::span<const std::uint32_t> words, const PathLayout& layout);
[[nodiscard]] std::vector<std::string> broken_invariants(std::span<const std::uint32_t> words, std::size_t objects,
                                                         const PathLayout& layout);

}  // namespace relook
