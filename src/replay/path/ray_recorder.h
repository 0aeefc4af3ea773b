// What a pass over a tile finds out about the rays of its trees, for the passes behind it: those of samples that were
// grown or shaded as a whole replace what was kept of them.
#pragma once
#include <utility>
#include <vector>

#include "trace/update/kept_rays.h"

namespace relook {

class RayRecorder {
 public:
  /// `kept`: of the tile so far; empty: nothing. `records_all`: every sample will be recorded.
  RayRecorder(const TileRays& kept, bool records_all) : kept_(kept), records_all_(records_all) {}

  /// Is anything kept, or to be kept, of the tile?
  [[nodiscard]] bool is_on() const { return records_all_ || !kept_.empty(); }
  [[nodiscard]] bool records_all() const { return records_all_; }

  /// Samples increase. `root`: of its tree in the block, as it is now.
  void record(const TreeBlock& block, std::uint32_t root, std::uint32_t sample) {
    samples_.push_back(sample);
    fresh_.append(block, root);
  }
  /// Of a recorded sample; the order is the same. `weights`: by node of the block.
  void add_weights(const TreeBlock& block, std::uint32_t root, std::span<const Color> weights) {
    const std::uint32_t sample = block.nodes[root].sample;
    for (std::size_t i = root + std::size_t{1}; i < block.nodes.size() && block.nodes[i].sample == sample; ++i)
      fresh_.weights.push_back(weights[i]);
  }

  [[nodiscard]] bool has_news() const { return records_all_ || !samples_.empty(); }
  /// What is to be kept from now on. Weights that some sample lacks are those of none.
  [[nodiscard]] TileRays take() {
    if (!fresh_.has_weights()) fresh_.weights.clear();
    if (!records_all_) return merged();
    fresh_.rays.shrink_to_fit();
    fresh_.weights.shrink_to_fit();
    return std::move(fresh_);
  }

 private:
  [[nodiscard]] TileRays merged() const {
    TileRays all;
    all.first.reserve(kept_.first.size());
    all.rays.reserve(kept_.rays.size());
    all.weights.reserve(kept_.weights.size());
    std::size_t next = 0;
    for (std::uint32_t sample = 0; sample < kept_.samples(); ++sample) {
      if (next < samples_.size() && samples_[next] == sample)
        all.append(fresh_, next++);
      else
        all.append(kept_, sample);
    }
    return all;
  }

  const TileRays& kept_;
  bool records_all_;
  std::vector<std::uint32_t> samples_;  // recorded ones, increasing
  TileRays fresh_;                      // of these
};

}  // namespace relook
