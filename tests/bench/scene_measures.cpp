#include "scene_measures.h"

#include <cstdio>

#include "base/parallel.h"
#include "files.h"
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
  options.note("Table 2", "ray paths and ray trees", "bytes a sample",
               static_cast<double>(resident.ray_paths + resident.ray_trees) / options.samples(), "", "56 to 84",
               Goal{32, true});
}

}  // namespace

void print_scene(const BenchOptions& options) {
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
  print_steps(options, replayer, journal, times.full_seconds);
  print_moves(options, image, journal, times.full_seconds);
  print_colors(options, image, journal, times.full_seconds);
  print_looks(options, image, journal, times.full_seconds);
  print_files(options, image, journal);
}

}  // namespace relook
