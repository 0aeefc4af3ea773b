#include "table2.h"

#include <cstdio>
#include <optional>
#include <string>

#include "bench_cache.h"
#include "image/regions.h"
#include "paper.h"
#include "replay/chosen_parameters.h"

namespace relook {
namespace {

/// A row; none: it is not kept there, or not known.
struct PieceRow {
  std::string name;
  std::optional<std::uint64_t> pieces, disk, memory;
  paper::Pieces of_paper;
};

void print_bytes(std::optional<std::uint64_t> bytes, double samples) {
  if (bytes)
    std::printf(" %9.2f %8.1f", static_cast<double>(*bytes) * 1e-6, static_cast<double>(*bytes) / samples);
  else
    std::printf(" %9s %8s", "-", "-");
}

void note_bytes(const BenchOptions& options, const PieceRow& row, const char* column,
                std::optional<std::uint64_t> bytes) {
  if (!bytes) return;
  char paper[32] = "";
  if (row.of_paper.megabytes > 0)
    std::snprintf(paper, sizeof paper, "%.1f", row.of_paper.megabytes * 1e6 / paper::kSamples);
  options.note("Table 2", row.name, column, static_cast<double>(*bytes) / options.samples(), "", paper);
}

void print_row(const BenchOptions& options, const PieceRow& row) {
  std::printf("%-34s", row.name.c_str());
  if (row.pieces)
    std::printf(" %10llu", static_cast<unsigned long long>(*row.pieces));
  else
    std::printf(" %10s", "-");
  print_bytes(row.disk, options.samples());
  print_bytes(row.memory, options.samples());
  if (row.of_paper.number > 0) std::printf(" %9.0f", row.of_paper.number);
  if (row.of_paper.megabytes > 0)
    std::printf(" %7.1f %8.1f", row.of_paper.megabytes, row.of_paper.megabytes * 1e6 / paper::kSamples);
  std::printf("\n");
  if (row.pieces) {
    char number[32];
    std::snprintf(number, sizeof number, "%.0f", row.of_paper.number);
    options.note("Table 2", row.name, "pieces", static_cast<double>(*row.pieces), "",
                 row.of_paper.number > 0 ? number : "");
  }
  note_bytes(options, row, "bytes a sample on disk", row.disk);
  note_bytes(options, row, "bytes a sample in memory", row.memory);
}

/// Of all tunnels of the image.
std::uint64_t tunnel_memory(std::size_t most, const Image& image, const Scene& scene) {
  const RayScene rays(scene);
  const GrowScene grow{rays, nullptr, image.view.max_depth, image.view.shadow_bits};
  ImageRegions regions({.tunnels = most});
  regions.build_tunnels(image, grow, [](PathId path) { return path; });
  return regions.tunnel_bytes();
}

/// Colour trees in which every parameter of every material may change. Their number is that of the trees that the first
/// colour edit of the journal evaluates.
PieceRow whole_color_trees(const BenchOptions& options, const Image& image, const Journal* journal) {
  PieceRow row{"colour trees (of all materials)", {}, {}, {}, paper::kColorTrees};
  SceneState state = load_scene(options);
  const ParameterSet all = parameters_at(state, "/materials");
  Replayer replayer(std::move(state), image);
  const std::uint64_t before = replayer.resident().color_trees;
  replayer.choose_parameters({all});
  row.memory = replayer.resident().color_trees - before;
  if (journal == nullptr) return row;
  for (const JournalStep& step : journal->steps) {
    const TimedStep once = timed(replayer, StepKind::step, whole_edit(step), *journal);
    if (once.result.classification.change != ChangeClass::color) break;
    if (!row.pieces || once.result.counters.color_trees_evaluated > *row.pieces)
      row.pieces = once.result.counters.color_trees_evaluated;
  }
  return row;
}

}  // namespace

void print_table2(const BenchOptions& options, const Image& image, const Journal* journal) {
  const ScratchFolder scratch;
  write_bench_cache(options, scratch / "one", {"--tunnels", "1"});
  write_bench_cache(options, scratch / "two", {"--tunnels", "2"});
  const CacheSize one = inspect_bench_cache(scratch / "one", scratch);
  const CacheSize two = inspect_bench_cache(scratch / "two", scratch);
  const Replayer replayer(load_scene(options), image, {.groups = 1});
  const Resident resident = replayer.resident();
  const Scene& scene = replayer.state().scene();
  std::printf(
      "\nTable 2: pieces; MB (10^6 bytes) and bytes a sample in a cache and in memory; the paper's. In a cache, ray "
      "trees are with the sample's path\nand colour; groups and colour trees are not stored\n");
  std::printf("%-34s %10s %9s %8s %9s %8s %9s %7s %8s\n", "", "pieces", "disk MB", "B/sample", "memory MB", "B/sample",
              "paper", "MB", "B/sample");
  print_row(options, whole_color_trees(options, image, journal));
  print_row(options, {"ray paths", two.pieces.ray_paths, two.paths, resident.ray_paths, paper::kRayPaths});
  print_row(options, {"1-groups", two.pieces.groups, {}, replayer.regions().group_bytes(), paper::kGroups});
  print_row(options, {"ray trees", two.pieces.ray_trees, two.trees, resident.ray_trees, paper::kRayTrees});
  print_row(options,
            {"tunnels, 2 a region", two.pieces.tunnels, two.tunnels, tunnel_memory(2, image, scene), paper::kTunnels});
  print_row(options,
            {"tunnels, 1 a region", one.pieces.tunnels, one.tunnels, tunnel_memory(1, image, scene), paper::kTunnels});
  print_row(options, {"whole cache, 2 a region", {}, two.total, {}, {}});
  const double kept = static_cast<double>(resident.ray_paths + resident.ray_trees) / options.samples();
  std::printf("%-34s %42.1f bytes a sample in memory (paper: 56 to 84; to reach: 32)\n", "ray paths and ray trees",
              kept);
  options.note("Table 2", "ray paths and ray trees", "bytes a sample in memory", kept, "", "56 to 84", Goal{32, true});
}

}  // namespace relook
