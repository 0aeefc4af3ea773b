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
    const bool with_weights = kept_.has_weights() && fresh_.has_weights();
    std::size_t next = 0;  // sample that is not there yet
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      append(kept_, next, samples_[k], with_weights, all);
      append(fresh_, k, k + 1, with_weights, all);
      next = samples_[k] + std::size_t{1};
    }
    append(kept_, next, kept_.samples(), with_weights, all);
    return all;
  }
  /// Appends samples from `from` up to `to`.
  static void append(const TileRays& some, std::size_t from, std::size_t to, bool with_weights, TileRays& all) {
    const std::uint32_t begin = some.first[from], end = some.first[to];
    const std::size_t here = all.rays.size();
    all.rays.insert(all.rays.end(), some.rays.begin() + begin, some.rays.begin() + end);
    if (with_weights) all.weights.insert(all.weights.end(), some.weights.begin() + begin, some.weights.begin() + end);
    for (std::size_t sample = from; sample < to; ++sample)
      all.first.push_back(hit_place(here + some.first[sample + 1] - begin));
  }

  const TileRays& kept_;
  bool records_all_;
  std::vector<std::uint32_t> samples_;  // recorded ones, increasing
  TileRays fresh_;                      // of these
};

}  // namespace relook
