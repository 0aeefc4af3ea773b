// Colour trees that are kept (paper 3.3, 4.1.1): for sets of parameters that steps have changed, the compressed trees
// of the samples that depend on them. What else an edit changes makes them invalid tile by tile.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "cache/residency/residency.h"
#include "color/compress/compressed_block.h"
#include "region/quadtree.h"
#include "replay/change.h"

namespace relook {

/// The compressed trees of one tile, for one set of parameters.
struct TileColorTrees {
  std::vector<CompressedBlock> blocks;
  std::vector<std::uint32_t> samples;  // of the tile, increasing: the roots of all blocks, one after the other
  Leaves leaves;                       // with any of the samples
  bool is_valid = false;               // false: to be built
  double build_seconds = 0;
  std::size_t bytes = 0;
};

/// The compressed trees of one set of parameters.
struct ColorTreeSet {
  ColorTreeSet(ParameterSet of, std::size_t tile_count, std::size_t place)
      : number(place), parameters(std::move(of)), tiles(tile_count) {}
  /// Is no tile to be built?
  [[nodiscard]] bool is_valid() const;

  std::size_t number;  // of the sets so far
  ParameterSet parameters;
  SplitTable splits;
  std::vector<TileColorTrees> tiles;
  std::shared_ptr<std::vector<std::uint8_t>> were_built;  // by tile: were trees for these parameters kept before?
  std::uint64_t last_change = 0, uses = 0;
};

class ColorTreeStore {
 public:
  /// `most_samples`: whose trees may be kept over all sets of parameters, m_c in the paper (4.1).
  ColorTreeStore(std::size_t tiles, std::uint64_t most_samples) : tile_count_(tiles), most_samples_(most_samples) {}

  [[nodiscard]] std::uint64_t most_samples() const { return most_samples_; }
  /// Only trees of these sets are kept from now on.
  void choose(std::vector<ParameterSet> sets) { chosen_ = std::move(sets); }
  /// The set whose trees an edit of `changed` is to use; null: none, it goes through the ray trees.
  [[nodiscard]] const ParameterSet* set_for(const ParameterSet& changed) const;
  /// What is kept for the parameters, perhaps nothing yet. Valid until trim(). `change`: the number of changes so far.
  [[nodiscard]] ColorTreeSet& of(const ParameterSet& parameters, std::uint64_t change);

  /// To be called with every change before its step's own trees are used.
  void note_colors(const ColorChange& change);
  /// The trees of a tile have changed.
  void note_trees(std::size_t tile);
  void clear();
  /// Puts what has been built in its place. Tiles may be put at the same time.
  void keep(TileColorTrees& place, TileColorTrees tile);
  void drop(TileColorTrees& place) { keep(place, {}); }

  /// After a step: drops what has the least information weight (paper 4.3: time to rebuild over size and over the
  /// number of changes since it was used) until no more samples than allowed are left. Returns the number of colour
  /// trees dropped.
  std::uint64_t trim();

  /// What could leave memory at once: not what of() gave and trim() has not taken back. What has gone, or is given, in
  /// the meantime does not leave when its turn comes.
  void list_victims(EvictionPolicy policy, std::uint64_t change, std::vector<Victim>& victims);

  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t samples() const;

 private:
  [[nodiscard]] std::shared_ptr<std::vector<std::uint8_t>> tiles_built(const ParameterSet& parameters);
  void erase(const std::function<bool(const ColorTreeSet&)>& condition);

  std::size_t tile_count_;
  std::uint64_t most_samples_, change_ = 0;
  std::size_t set_count_ = 0;  // so far
  std::atomic<std::uint64_t> bytes_ = 0;
  std::vector<std::shared_ptr<ColorTreeSet>> sets_;
  struct Built {
    ParameterSet parameters;
    std::shared_ptr<std::vector<std::uint8_t>> tiles;
  };
  std::vector<Built> built_;                         // sets so far, the last begun last; see kMostRemembered
  std::optional<std::vector<ParameterSet>> chosen_;  // none: any set may be kept
  const ColorTreeSet* at_work_ = nullptr;
};

}  // namespace relook
