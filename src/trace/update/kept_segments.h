// Where all segments of stored trees run, kept from one step to the next: when objects move, one scan over the tile's
// segments says which samples the selection may meet or may have met, without growing a tree. It errs to more: a sample
// that it leaves out has no segment that SegmentTests would test. Derived from ray trees under Integrator::path;
// written and read by replay/path, held by StoredImage.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/tree/tree_block.h"
#include "trace/update/segment_grid.h"

namespace relook {

/// What of a selection segments are tested against: rays, shadow segments that reach their light, filtered or not, and
/// those that do not.
enum class SegmentKind : std::uint8_t { ray, open, blocked };
inline constexpr std::size_t kSegmentKinds = 3;

/// A selection, as segments of a kind see it.
struct SelectionBoxes {
  Box all;                 // empty: no such segment is tested
  std::vector<Box> parts;  // of it, together around all that is in it; empty: it is one
};
struct SegmentSelection {
  std::array<SelectionBoxes, kSegmentKinds> of;  // by SegmentKind
  float condition = 1;                           // as of SelectionBounds
};

class TileSegments {
 public:
  TileSegments() = default;
  explicit TileSegments(const SegmentGrid& grid) : grid_(grid) {}

  [[nodiscard]] bool empty() const { return samples() == 0; }
  [[nodiscard]] std::size_t samples() const { return lists_[0].first.size() - 1; }
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] const SegmentGrid& grid() const { return grid_; }
  /// Of a sample.
  [[nodiscard]] std::uint32_t count(SegmentKind kind, std::size_t sample) const {
    const std::vector<std::uint32_t>& first = lists_[static_cast<std::size_t>(kind)].first;
    return first[sample + 1] - first[sample];
  }

  /// Appends those of the tree that begins at `root`. Requires: the block keeps lines.
  void append(const RayScene& scene, const TreeBlock& block, std::uint32_t root);
  /// Appends samples of another tile's, of the same grid, from `from` up to `to`.
  void append(const TileSegments& other, std::size_t from, std::size_t to);
  void shrink_to_fit();
  /// Makes room for about as many as both have.
  void reserve(const TileSegments& some, const TileSegments& others);

  /// Are the selection's boxes such that they can be told apart from others?
  [[nodiscard]] bool can_tell(const SegmentSelection& selection) const;
  /// Sets those of samples [samples] that the selection may touch to 1. Requires: can_tell().
  void find_touched(const SegmentSelection& selection, std::span<std::uint8_t> touched) const;

 private:
  /// Of a kind, sample by sample.
  struct List {
    std::array<std::vector<std::uint16_t>, 6> ends;
    std::vector<std::uint32_t> first{0};  // [samples + 1]
    float largest = 0;                    // coordinate, by magnitude, that one sets out from
  };

  void add(SegmentKind kind, const Ray& ray);
  static void find_touched(const List& list, std::span<const GridBox> boxes, std::span<std::uint8_t> touched);
  /// The box of all, then those of its parts; empty: they cannot be told.
  [[nodiscard]] std::vector<GridBox> grid_boxes(const List& list, const SelectionBoxes& boxes, float condition) const;

  SegmentGrid grid_;
  std::array<List, kSegmentKinds> lists_;
};

}  // namespace relook
