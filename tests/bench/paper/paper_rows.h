// Rows of Table 3: our times beside the paper's, each with its ratio to the full render it was measured with.
#pragma once
#include <string>
#include <vector>

#include "setup.h"

namespace relook {

/// Seconds; 0: there is none.
struct PaperCell {
  std::string column;
  double ours = 0, paper = 0;
};

/// The full render, timed again beside each measure, so that a busy moment of the machine does not make it seem slow.
class FullRender {
 public:
  explicit FullRender(const BenchOptions& options);
  void again();
  [[nodiscard]] double seconds() const { return seconds_; }  // of the fastest

 private:
  SceneState state_;
  ViewOptions view_;
  double seconds_ = 0;
};

/// Two lines: ours in milliseconds, and the paper's in seconds. `has_goals`: to reach the paper's ratios.
void print_paper_row(const BenchOptions& options, const std::string& table, const std::string& row,
                     const std::vector<PaperCell>& cells, double full_seconds, bool has_goals);
/// A line of the same columns.
void print_paper_head(const std::string& name, const std::vector<std::string>& columns);

}  // namespace relook
