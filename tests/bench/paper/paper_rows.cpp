#include "paper_rows.h"

#include <cstdio>

#include "image/render.h"
#include "paper.h"

namespace relook {
namespace {

void print_value(double value, double ratio) {
  if (value > 0)
    std::printf(" %8.2f %6.*f", value, ratio < 10 ? 1 : 0, ratio);
  else
    std::printf(" %8s %6s", "-", "-");
}

std::string ratio_text(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", ratio < 10 ? 1 : 0, ratio);
  return text;
}

}  // namespace

FullRender::FullRender(const BenchOptions& options) : state_(load_scene(options)), view_(options.view) {
  for (int run = 0; run < 3; ++run) again();
}

void FullRender::again() {
  const double seconds = time_of([&] {
    RenderStats stats;
    static_cast<void>(render(state_.scene(), view_, stats));
  });
  if (seconds_ == 0 || seconds < seconds_) seconds_ = seconds;
}

void print_paper_head(const std::string& name, const std::vector<std::string>& columns) {
  std::printf("%-36.36s", name.c_str());
  for (const std::string& column : columns) std::printf(" %15.15s", column.c_str());
  std::printf("\n");
}

void print_paper_row(const BenchOptions& options, const std::string& table, const std::string& row,
                     const std::vector<PaperCell>& cells, double full_seconds, bool has_goals) {
  std::printf("%-36.36s", row.c_str());
  for (const PaperCell& cell : cells) print_value(cell.ours * 1e3, full_seconds / cell.ours);
  std::printf("\n%36s", "paper, s");
  for (const PaperCell& cell : cells) print_value(cell.paper, paper::kFullSeconds / cell.paper);
  std::printf("\n");
  for (const PaperCell& cell : cells) {
    if (cell.ours <= 0) continue;
    const double of_paper = cell.paper > 0 ? paper::kFullSeconds / cell.paper : 0;
    options.note(table, row, cell.column, full_seconds / cell.ours, "", of_paper > 0 ? ratio_text(of_paper) : "",
                 has_goals && of_paper > 0 ? std::optional(Goal{of_paper}) : std::nullopt);
  }
}

}  // namespace relook
