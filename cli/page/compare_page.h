// The page of `relook compare` (compare.html): the frames' figures, those that differ, the worst first, in the
// viewer of runs' pages, and runs side by side. One file that needs nothing else; whatever comes from files is text.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "input/compare_inputs.h"
#include "report/run_table.h"

namespace relook {

class ComparePage {
 public:
  /// `a`: what all else is compared with. `white`: PSNR's peak.
  /// `exposure`: stops, of its pictures.
  ComparePage(std::string a, DisplayWhite white, double exposure)
      : a_(std::move(a)), white_(white), exposure_(exposure) {}
  void add_pair(const std::string& b, const PairComparison& pair);
  void set_runs(const RunTable& table);
  [[nodiscard]] std::string text() const;

 private:
  void add_frame(const std::string& b, const std::string& name, const FrameComparison& comparison,
                 const Pictures& pictures);

  std::string a_, pairs_, runs_;  // HTML
  DisplayWhite white_;
  double exposure_;
  std::vector<std::pair<double, std::string>> frames_;  // how far apart, and JSON for compare.js
};

}  // namespace relook
