// The page of `relook compare` (compare.html): the frames' figures, pictures of those that differ, and runs side by
// side. One file that needs nothing else, without scripts; whatever comes from files is text.
#pragma once
#include <string>

#include "input/compare_inputs.h"
#include "report/run_table.h"

namespace relook {

class ComparePage {
 public:
  /// `a`: what all else is compared with. `white`: PSNR's peak.
  ComparePage(std::string a, DisplayWhite white) : a_(std::move(a)), white_(white) {}
  void add_pair(const std::string& b, const PairComparison& pair);
  void set_runs(const RunTable& table);
  [[nodiscard]] std::string text() const;

 private:
  std::string a_, pairs_, runs_;  // HTML
  DisplayWhite white_;
};

}  // namespace relook
