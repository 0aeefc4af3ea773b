#include "table2.h"

#include <cstdio>
#include <string>

#include "engine/regions.h"

namespace relook {
namespace {

/// A column of Table 2, Figure 4 (complex); 0: the paper gives none.
struct PaperPieces {
  double pieces = 0, megabytes = 0;
};
// Brière & Poulin 1996, Table 2. Bytes a sample: over the image's 256 x 256 pixels, one sample each.
constexpr PaperPieces kPaperPaths{5300, 0}, kPaperGroups{12100, 0}, kPaperTrees{66000, 3.7}, kPaperTunnels{10900, 4.3};
constexpr double kPaperSamples = 256.0 * 256.0;

PathId own_class(PathId path) { return path; }

void print_row(const BenchOptions& options, const char* name, std::size_t pieces, std::uint64_t bytes,
               const PaperPieces& paper) {
  const double samples = options.samples();
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", paper.pieces);
  options.note("Table 2", name, "pieces", static_cast<double>(pieces), "", text);
  options.note("Table 2", name, "MB", static_cast<double>(bytes) * 1e-6);
  std::snprintf(text, sizeof text, "%.1f", paper.megabytes * 1e6 / kPaperSamples);
  options.note("Table 2", name, "bytes a sample", static_cast<double>(bytes) / samples, "",
               paper.megabytes > 0 ? text : "");
  std::printf("%-28s %10zu %9.2f %10.1f  %8.0f", name, pieces, static_cast<double>(bytes) * 1e-6,
              static_cast<double>(bytes) / samples, paper.pieces);
  if (paper.megabytes > 0)
    std::printf(" %9.1f %10.1f\n", paper.megabytes, paper.megabytes * 1e6 / kPaperSamples);
  else
    std::printf(" %9s %10s\n", "-", "-");
}

/// The 1-groups of all tiles.
std::size_t count_groups(const Image& image) {
  ImageRegions regions({.groups = 1});
  regions.build_groups(image, own_class);
  std::size_t sum = 0;
  for (std::size_t tile = 0; tile < image.trees.size(); ++tile) {
    const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
    sum += count_groups(regions.groups(tile), image.trees[tile], rect.x1 - rect.x0, image.view.samples, own_class);
  }
  return sum;
}

/// Prints the row of tunnels; returns the seconds of building them.
double print_tunnels(const BenchOptions& options, std::size_t most, const Image& image, const GrowScene& grow) {
  ImageRegions regions({.tunnels = most});
  const double seconds = fastest(3, [&] { regions.build_tunnels(image, grow, own_class); });
  std::size_t tunnels = 0, sections = 0;
  for (std::size_t tile = 0; tile < image.trees.size(); ++tile) {
    tunnels += regions.tunnels(tile).tunnels();
    sections += regions.tunnels(tile).sections();
  }
  const std::string name = "tunnels, " + std::to_string(most) + " a region";
  print_row(options, name.c_str(), tunnels, regions.tunnel_bytes(), kPaperTunnels);
  std::printf("%-28s %10zu\n", "  their sections", sections);
  return seconds;
}

void print_share(const std::string& name, double seconds, const RenderTimes& times, const char* goal) {
  std::printf("%-46s %10.2f ms, %.1f %% of preprocessing%s\n", name.c_str(), seconds * 1e3,
              100 * seconds / times.preprocess_seconds, goal);
}

}  // namespace

void print_table2(const BenchOptions& options, const Scene& scene, const Image& image, const Resident& resident,
                  const RenderTimes& times) {
  std::printf("\n%-28s %10s %9s %10s  %8s %9s %10s\n", "Table 2", "pieces", "MB", "B/sample", "paper", "MB",
              "B/sample");
  print_row(options, "ray paths", image.paths.size(), resident.ray_paths, kPaperPaths);
  ImageRegions regions(RegionOptions{});
  const double group_seconds = fastest(3, [&] { regions.build_groups(image, own_class); });
  const std::string groups = "1-groups (bytes: up to " + std::to_string(regions.options().groups) + ")";
  print_row(options, groups.c_str(), count_groups(image), regions.group_bytes(), kPaperGroups);
  print_row(options, "ray trees", static_cast<std::size_t>(options.samples()), resident.ray_trees, kPaperTrees);
  const RayScene rays(scene);
  const GrowScene grow{rays, nullptr, image.view.max_depth, image.view.shadow_bits};
  const double one_seconds = print_tunnels(options, 1, image, grow);
  const double two_seconds = print_tunnels(options, 2, image, grow);
  print_share("building groups", group_seconds, times, "");
  print_share("building tunnels, 1 a region", one_seconds, times, "");
  print_share("building tunnels, 2 a region", two_seconds, times, "");
  print_share("groups and 1 tunnel a region together", group_seconds + one_seconds, times, " (to reach: 20 %)");
  options.note("Table 2", "groups and 1 tunnel a region", "time to build, of preprocessing",
               100 * (group_seconds + one_seconds) / times.preprocess_seconds, "%", "", Goal{20, true});
}

}  // namespace relook
