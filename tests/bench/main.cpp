// relook_bench SCENE JOURNAL|- [WIDTHxHEIGHT [SAMPLES]]: the measures of the project on one scene, as ratios within one
// run, beside the paper's figures (Brière & Poulin 1996, Tables 2 and 3, where a full render takes 640 s).
// relook_bench growth SCENE JOURNAL: the price of edits at growing numbers of samples.
// relook_bench budget SCENE JOURNAL [WIDTHxHEIGHT [SAMPLES]]: what edits cost when not everything is kept.
#include <cstdio>
#include <exception>
#include <string_view>

#include "base/parallel.h"
#include "budget.h"
#include "growth.h"
#include "render_measures.h"
#include "table2.h"
#include "table3_colors.h"
#include "table3_looks.h"
#include "table3_moves.h"

namespace relook {
namespace {

void print_sizes(const Image& image, const Resident& resident, const BenchOptions& options) {
  std::printf("%-46s %10zu, %.1f MB\n", "ray paths (paper, 256x256: 5,300)", image.paths.size(),
              static_cast<double>(resident.ray_paths) * 1e-6);
  std::printf("%-46s %10.1f bytes (paper: 56 to 84; to reach: 32)\n", "ray paths and ray trees, a sample",
              static_cast<double>(resident.ray_paths + resident.ray_trees) / options.samples());
}

void run(const BenchOptions& options) {
  SceneState state = load_scene(options);
  std::printf("relook_bench: %s at %ux%u, %u sample(s), %zu thread(s), %zu objects\n", options.scene.c_str(),
              options.width, options.height, options.view.samples, thread_count(), state.scene().objects.size());
  Image image;
  const RenderTimes times = print_render(options, state, image);
  print_texture_price(state, times);
  Replayer replayer(std::move(state), image);
  print_sizes(image, replayer.resident(), options);
  print_table2(options, replayer.state().scene(), image, replayer.resident(), times);
  if (options.journal == "-") return;
  const Journal journal = read_journal(options.journal);
  print_steps(replayer, journal, times.full_seconds);
  print_moves(options, image, journal, times.full_seconds);
  print_colors(options, image, journal, times.full_seconds);
  print_looks(options, image, journal, times.full_seconds);
}

}  // namespace
}  // namespace relook

int main(int count, char** arguments) {
  try {
    if (count > 1 && std::string_view(arguments[1]) == "growth")
      relook::print_growth(relook::parse_options(count - 1, arguments + 1));
    else if (count > 1 && std::string_view(arguments[1]) == "budget")
      relook::print_budgets(relook::parse_options(count - 1, arguments + 1));
    else
      relook::run(relook::parse_options(count, arguments));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "relook_bench: %s\n", error.what());
    return 2;
  }
}
