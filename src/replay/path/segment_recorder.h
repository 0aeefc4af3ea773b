// What a pass over a tile finds out about where segments run: those of samples whose trees are others now replace what
// was kept of them, or all are written down.
#pragma once
#include <utility>
#include <vector>

#include "trace/update/kept_segments.h"

namespace relook {

class SegmentRecorder {
 public:
  enum class Mode : std::uint8_t { none, changes, all };

  /// `kept`: of the tile so far; outlives it. `grid`: of what is written down if that is all.
  SegmentRecorder(Mode mode, const TileSegments& kept, const SegmentGrid& grid)
      : mode_(mode), kept_(kept), fresh_(mode == Mode::all ? grid : kept.grid()) {}

  [[nodiscard]] bool is_on() const { return mode_ != Mode::none; }
  [[nodiscard]] bool records_all() const { return mode_ == Mode::all; }
  /// Samples increase. `root`: of its tree in the block, as it is now.
  void record(const RayScene& scene, const TreeBlock& block, std::uint32_t root) {
    samples_.push_back(block.nodes[root].sample);
    fresh_.append(scene, block, root);
  }
  [[nodiscard]] bool has_news() const { return !samples_.empty(); }
  /// What is to be kept from now on.
  [[nodiscard]] TileSegments take() {
    if (records_all()) {
      fresh_.shrink_to_fit();
      return std::move(fresh_);
    }
    TileSegments all(kept_.grid());
    all.reserve(kept_, fresh_);
    std::size_t next = 0;  // sample that is not there yet
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      all.append(kept_, next, samples_[k]);
      all.append(fresh_, k, k + 1);
      next = samples_[k] + std::size_t{1};
    }
    all.append(kept_, next, kept_.samples());
    return all;
  }

 private:
  Mode mode_;
  const TileSegments& kept_;
  std::vector<std::uint32_t> samples_;  // recorded ones, increasing
  TileSegments fresh_;                  // of these
};

}  // namespace relook
