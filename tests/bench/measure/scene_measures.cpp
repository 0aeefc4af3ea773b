#include "scene_measures.h"

#include <cstdio>

#include "base/parallel.h"
#include "files.h"
#include "image/render.h"
#include "paper.h"
#include "render_measures.h"
#include "table2.h"
#include "table3_looks.h"
#include "table3_moves.h"

namespace relook {
namespace {

void print_title(const BenchOptions& options, const char* what) {
  std::printf("relook_bench%s: %s at %ux%u, %u sample(s), %zu thread(s)\n", what, options.scene.c_str(), options.width,
              options.height, options.view.samples, thread_count());
}

/// Tables 2 and 3. `has_details`: with what bounds the times of Table 3.
void print_paper_tables(const BenchOptions& options, const Image& image, const Journal& journal, bool has_details) {
  print_table2(options, image, &journal);
  std::fflush(stdout);
  FullRender full(options);
  const LookTable looks = time_looks(options, image, journal, full);
  const MoveTable moves = time_moves(options, image, journal, full);
  std::printf("\nfull render of Table 3 (fastest of those timed between its rows): %.1f ms; the paper's: %.0f s\n",
              full.seconds() * 1e3, paper::kFullSeconds);
  print_looks(options, looks, full.seconds());
  print_moves(options, moves, full.seconds());
  if (!has_details) return;
  print_look_details(options, looks, full.seconds());
  print_move_details(options, moves, full.seconds());
}

}  // namespace

void print_tables(const BenchOptions& options) {
  print_title(options, " tables");
  const SceneState state = load_scene(options);
  RenderStats stats;
  const Image image = preprocess(state.scene(), options.view, stats);
  print_paper_tables(options, image, read_journal(options.journal), false);
}

void print_scene(const BenchOptions& options) {
  const SceneState state = load_scene(options);
  print_title(options, "");
  Image image;
  const RenderTimes times = print_render(options, state, image);
  print_texture_price(state, times);
  if (options.journal == "-") {
    print_table2(options, image, nullptr);
    return;
  }
  const Journal journal = read_journal(options.journal);
  print_paper_tables(options, image, journal, true);
  print_files(options, image, journal);
}

}  // namespace relook
