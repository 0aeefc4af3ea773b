// The colour and optical rows of the paper's Table 3, and what bounds our times of them.
#pragma once
#include <array>

#include "paper_rows.h"
#include "search_time.h"

namespace relook {

inline constexpr std::array<double, 4> kLookShares{0, 0.01, 0.1, 1};  // of ray trees: the columns

/// A step; seconds, each the fastest of some runs.
struct LookTimes {
  std::string name;
  ChangeClass change = ChangeClass::base;
  SearchTimes search;
  std::array<double, kLookShares.size()> by_ray_trees{};
  double chosen = 0, later = 0;  // with compressed colour trees that are there from the start; of later edits
  double first = 0;              // with those that are built for it, once
  double samples = 0, pixels = 0, column_bytes = 0;
  double segments_again = 0, work = 0;  // of optical steps: share of segments; see time_pixel_work()
};

struct LookTable {
  std::vector<LookTimes> rows;
  std::array<double, kLookShares.size()> kept{};  // share of the samples whose ray trees were kept
};

/// Measures all colour and optical steps of the journal, each after those before it. `image`: preprocessed from the
/// scene of `options`. `full`: timed beside.
[[nodiscard]] LookTable time_looks(const BenchOptions& options, const Image& image, const Journal& journal,
                                   FullRender& full);
/// Beside the paper's.
void print_looks(const BenchOptions& options, const LookTable& table, double full_seconds);
/// First edits of parameters that nobody chose; bytes of compressed trees; what later edits move; work of optical
/// edits.
void print_look_details(const BenchOptions& options, const LookTable& table, double full_seconds);

}  // namespace relook
