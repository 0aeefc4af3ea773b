// The geometric rows of the paper's Table 3: removing, rendering and adding of a selection, by shares of ray trees and
// with 0, 1 and 2 tunnels; and what bounds our times of them.
#pragma once
#include <algorithm>
#include <array>

#include "paper_rows.h"

namespace relook {

inline constexpr std::array<double, 3> kMoveShares{1, 0.1, 0.01};  // of ray trees
inline constexpr std::size_t kTunnelCounts = 3;                    // 0, 1, 2

/// A move as a drag, and as one step. The first frame of a drag removes the selection and renders it; drawn again, it
/// only renders it: the difference is removing.
struct MoveTimes {
  TimedStep first, again;
  std::vector<TimedStep> later;  // further frames
  TimedStep release, merged;
  double first_work = 0, merged_work = 0;  // see time_pixel_work(); 0: not measured
  std::vector<double> later_work;
  [[nodiscard]] double removing() const { return std::max(0.0, first.seconds - again.seconds); }
  [[nodiscard]] double rendering() const;  // mean of the frames
};

struct MoveRow {
  std::string name;
  std::array<std::array<MoveTimes, kTunnelCounts>, kMoveShares.size()> times;
};
struct MoveTable {
  std::vector<MoveRow> rows;
  std::array<double, kMoveShares.size()> kept{};  // share of the samples whose ray trees were kept
};

/// Measures the drags and geometric edits of the journal. `image`: preprocessed from the scene of `options`. `full`:
/// timed beside.
[[nodiscard]] MoveTable time_moves(const BenchOptions& options, const Image& image, const Journal& journal,
                                   FullRender& full);
/// Beside the paper's.
void print_moves(const BenchOptions& options, const MoveTable& table, double full_seconds);
/// With all ray trees: each part against the work and against the full render's share of the pixels that change.
void print_move_details(const BenchOptions& options, const MoveTable& table, double full_seconds);

}  // namespace relook
