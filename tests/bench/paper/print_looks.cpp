// The text that print_looks() prints for a LookTable: our milliseconds beside the paper's, row by row.
#include <cstdio>
#include <cstring>
#include <thread>

#include "paper.h"
#include "table3_looks.h"
#include "tree_shares.h"

namespace relook {
namespace {

/// Bytes a second that both threads read and write in a plain copy.
double copy_bandwidth() {
  constexpr std::size_t kBytes = std::size_t{128} << 20;
  std::vector<char> from(kBytes, 1), to(kBytes, 2);
  const double seconds = fastest(5, [&] {
    std::thread other([&] { std::memcpy(to.data(), from.data(), kBytes / 2); });
    std::memcpy(to.data() + kBytes / 2, from.data() + kBytes / 2, kBytes / 2);
    other.join();
  });
  return 2 * static_cast<double>(kBytes) / seconds;
}

}  // namespace

void print_looks(const BenchOptions& options, const LookTable& table, double full_seconds) {
  std::printf(
      "\nTable 3, colour and optical rows: milliseconds and full render / time; below, the paper's "
      "seconds and the same ratio. SDP: selection-dependent\npreprocessing, which is not in the other columns. Ray "
      "trees are kept tile by tile: what truly was kept is in the heads. Colour tree: there from the start, its\nfirst "
      "edit; compression: later edits\n");
  std::vector<std::string> columns{"SDP, no groups", "SDP, groups", "only ray paths"};
  for (std::size_t k = 1; k < kLookShares.size(); ++k)
    columns.push_back(tree_share_head(kLookShares[k], table.kept[k]));
  columns.insert(columns.end(), {"colour tree", "compression"});
  print_paper_head("step", columns);
  for (const LookTimes& times : table.rows) {
    const paper::Look of_paper = paper::look(times.name);
    std::vector<PaperCell> cells{{columns[0], times.search.without, of_paper.without_groups},
                                 {columns[1], times.search.with, of_paper.with_groups}};
    for (std::size_t k = 0; k < kLookShares.size(); ++k)
      cells.push_back({columns[2 + k], times.by_ray_trees[k], of_paper.by_ray_trees[k]});
    cells.push_back({columns[6], times.chosen, of_paper.color_trees});
    cells.push_back({columns[7], times.later, of_paper.compressed});
    print_paper_row(options, "Table 3, colour and optical rows: full render / time", times.name, cells, full_seconds,
                    true);
  }
}

void print_look_details(const BenchOptions& options, const LookTable& table, double full_seconds) {
  constexpr double kPixelBytes = 4 * sizeof(Rgba);  // colour and pixel of a sample, each read and written
  constexpr double kWedge = 25, kMostWedge = 3;
  const double bandwidth = copy_bandwidth();
  std::printf(
      "\nColour and optical rows, more: the first edit of parameters that nobody chose (finding and compressing its "
      "samples, evaluating them). Bytes: columns a sample.\nMoved: columns and pixels of later edits, share of a plain "
      "copy (%.0f GB/s read and written; to reach: 50 %%). Wedge: 25 values / one (a first edit and 24 later ones;\nto "
      "reach: 3). Work: tracing and shading just the pixels that change afresh\n",
      bandwidth * 1e-9);
  std::printf("%-28s %-8s %9s %8s %9s %7s %7s %7s %7s %9s %9s %7s\n", "step", "class", "affected", "pixels", "first ms",
              "x", "bytes", "moved", "wedge", "segments", "work ms", "/work");
  for (const LookTimes& times : table.rows) {
    std::printf("%-28.28s %-8s", times.name.c_str(), std::string(change_class_name(times.change)).c_str());
    if (times.change == ChangeClass::color) {
      const double moved = (times.column_bytes + times.samples * kPixelBytes) / times.later / bandwidth;
      const double wedge = (times.first + (kWedge - 1) * times.later) / times.first;
      const double bytes = times.column_bytes / times.samples;
      std::printf(" %8.1f%% %7.1f%% %9.2f %7.0f %7.1f %6.0f%% %7.1f\n", 100 * times.samples / options.samples(),
                  100 * times.pixels / options.pixels(), times.first * 1e3, full_seconds / times.first, bytes,
                  100 * moved, wedge);
      const char* const place = "Colour rows: compressed colour trees";
      options.note(place, times.name, "full render / first edit, nothing chosen", full_seconds / times.first);
      options.note(place, times.name, "moved / a plain copy", 100 * moved, "%", "", Goal{50});
      options.note(place, times.name, "25 values / one", wedge, "", "", Goal{kMostWedge, true});
      options.note(place, times.name, "bytes a sample", bytes, "", "310 to 516 (whole trees)", Goal{160, true});
    } else {
      const double edit = times.by_ray_trees.back();
      std::printf(" %9s %7.1f%% %9s %7s %7s %7s %7s %8.1f%% %9.2f %7.2f\n", "", 100 * times.pixels / options.pixels(),
                  "", "", "", "", "", 100 * times.segments_again, times.work * 1e3, edit / times.work);
      options.note("Optical row", times.name, "edit / work", edit / times.work);
    }
  }
}

}  // namespace relook
