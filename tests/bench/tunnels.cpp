#include "tunnels.h"

#include <array>
#include <cstdio>

#include "base/error.h"
#include "base/parallel.h"
#include "bench_cache.h"
#include "image/render.h"

namespace relook {
namespace {

constexpr std::array<std::uint32_t, 3> kCounts{0, 1, 2};  // of a region
constexpr int kRounds = 5;

/// The first edit of a journal that moves something, or a small move of the first node with a mesh.
struct Move {
  Journal journal;
  std::string name;
  Edit edit;
};

Move small_move(const SceneState& state) {
  const Json& nodes = state.document().look.at("nodes");
  for (const auto& [name, node] : nodes.items()) {
    if (!node.contains("mesh")) continue;
    Json place = node.value("translation", Json{0, 0, 0});
    place[0] = place[0].get<double>() + 0.01;
    PatchOperation operation;
    operation.op = node.contains("translation") ? PatchOp::replace : PatchOp::add;
    operation.path = (Json::json_pointer("/nodes") / name / "translation").to_string();
    operation.value = std::move(place);
    return {{}, "move of \"" + name + "\" by 1 cm", {std::move(operation)}};
  }
  throw InputError(state.document().file, "/nodes", "no node with a mesh to move");
}

Move first_move(const BenchOptions& options) {
  if (options.journal == "-") return small_move(load_scene(options));
  const Journal journal = read_journal(options.journal);
  for (const JournalStep& step : journal.steps) {
    SceneState state = load_scene(options);
    const Edit edit = whole_edit(step);
    const SceneDelta delta = apply_edit(state, edit, journal.file, journal.path.parent_path());
    if (classify(state.scene(), delta).change == ChangeClass::geometric) return {journal, step.name, edit};
  }
  throw InputError(journal.file, "/steps", "no geometric step");
}

/// From the opening of a cache to a frame after the move, in seconds.
struct FirstFrame {
  double opening = 0, step = 0;
  [[nodiscard]] double total() const { return opening + step; }
};

FirstFrame time_first_frame(const std::filesystem::path& cache, std::uint32_t tunnels, const Move& move) {
  FirstFrame times;
  RegionOptions regions;
  regions.tunnels = tunnels;
  std::unique_ptr<Replayer> replayer;
  times.opening = time_of([&] {
    OpenedCache opened = open_bench_cache(cache);
    replayer = std::make_unique<Replayer>(std::move(*opened.state), std::move(opened.image), regions, nullptr,
                                          std::move(opened.tunnels));
  });
  times.step = timed(*replayer, StepKind::step, move.edit, move.journal).seconds;
  return times;
}

void keep_faster(FirstFrame& best, const FirstFrame& times) {
  if (best.total() == 0 || times.total() < best.total()) best = times;
}

/// Of one number of tunnels a region.
struct Line {
  double preprocess = 0;
  CacheSize cache;
  std::uint64_t memory = 0;  // bytes of all tunnels
  FirstFrame stored, built;
};

struct TunnelTimes {
  double full = 0;
  std::array<Line, kCounts.size()> lines;
};

void keep_less(double& best, double seconds) {
  if (best == 0 || seconds < best) best = seconds;
}

/// Renders and preprocesses in turn.
void time_preprocessing(const BenchOptions& options, TunnelTimes& times) {
  const SceneState state = load_scene(options);
  for (int round = 0; round < kRounds; ++round) {
    RenderStats stats;
    keep_less(times.full, time_of([&] { static_cast<void>(render(state.scene(), options.view, stats)); }));
    for (std::size_t k = 0; k < kCounts.size(); ++k) {
      TunnelRecord record;
      record.shape.of_region = kCounts[k];
      Image image;
      keep_less(times.lines[k].preprocess, time_of([&] {
                  image = preprocess(state.scene(), options.view, stats, {}, kCounts[k] > 0 ? &record : nullptr);
                }));
    }
  }
}

/// Bytes of the tunnels that are there once a replay has read all of them.
std::uint64_t memory_of_tunnels(const std::filesystem::path& cache, std::uint32_t tunnels) {
  const OpenedCache opened = open_bench_cache(cache);
  const RayScene rays(opened.state->scene());
  ImageRegions regions({.tunnels = tunnels});
  const ViewOptions& view = opened.image.view;
  regions.build_tunnels(opened.image, {rays, nullptr, view.max_depth, view.shadow_bits},
                        [](PathId path) { return path; });
  return regions.tunnel_bytes();
}

TunnelTimes time_tunnels(const BenchOptions& options, const Move& move) {
  TunnelTimes times;
  time_preprocessing(options, times);
  const ScratchFolder scratch;
  const auto cache_of = [&](std::uint32_t count) { return scratch / std::to_string(count).c_str(); };
  for (std::size_t k = 0; k < kCounts.size(); ++k) {
    write_bench_cache(options, cache_of(kCounts[k]), {"--tunnels", std::to_string(kCounts[k])});
    times.lines[k].cache = inspect_bench_cache(cache_of(kCounts[k]), scratch);
    if (kCounts[k] > 0) times.lines[k].memory = memory_of_tunnels(cache_of(kCounts[k]), kCounts[k]);
  }
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t k = 0; k < kCounts.size(); ++k) {
      keep_faster(times.lines[k].built, time_first_frame(cache_of(0), kCounts[k], move));
      if (kCounts[k] > 0) keep_faster(times.lines[k].stored, time_first_frame(cache_of(kCounts[k]), kCounts[k], move));
    }
  return times;
}

void print_line(const BenchOptions& options, std::uint32_t count, const Line& line, const TunnelTimes& times) {
  const double samples = options.samples(), ratio = line.preprocess / times.full;
  std::printf("%7u %10.0f %7.2f %10llu %8.2f %8.2f %10.2f", count, line.preprocess * 1e3, ratio,
              static_cast<unsigned long long>(line.cache.pieces.tunnels),
              static_cast<double>(line.cache.tunnels) / samples, static_cast<double>(line.memory) / samples,
              static_cast<double>(line.cache.total) / samples);
  const auto print_frame = [](const FirstFrame& frame) {
    std::printf("  %6.0f + %5.0f = %5.0f", frame.opening * 1e3, frame.step * 1e3, frame.total() * 1e3);
  };
  print_frame(line.built);
  const std::string row = std::to_string(count) + " a region";
  const auto note = [&](const char* column, double value, const char* unit = "", const char* paper = "",
                        std::optional<Goal> goal = std::nullopt) {
    options.note("Tunnels in the cache", row, column, value, unit, paper, goal);
  };
  note("preprocess / full render", ratio, "", "1.72", Goal{1.3, true});
  note("bytes a sample on disk", static_cast<double>(line.cache.tunnels) / samples);
  note("bytes a sample in memory", static_cast<double>(line.memory) / samples, "", "66");
  if (count > 0) {
    const double saved = line.built.total() - line.stored.total();
    print_frame(line.stored);
    std::printf(" %8.0f %7.1f%%", saved * 1e3, 100 * saved / line.preprocess);
    note("opening to first move: saved, of preprocessing", 100 * saved / line.preprocess, "%");
    note("opening to first move: built / stored", line.built.total() / line.stored.total());
  }
  std::printf("\n");
}

}  // namespace

void print_tunnels(const BenchOptions& options) {
  const Move move = first_move(options);
  const TunnelTimes times = time_tunnels(options, move);
  std::printf(
      "relook_bench tunnels: %s at %ux%u, %u sample(s), %zu thread(s); full render %.0f ms, fastest of %d\n"
      "preprocess: without writing; x: over the full render (paper: 1.72; to reach: 1.3). Tunnels that are stored; "
      "their bytes a sample on disk and in memory (paper: 66), and of\nthe whole cache. Milliseconds from the opening "
      "of a "
      "cache to the first frame of \"%s\" in this process, without writing it: opening + step, of a cache\nwithout "
      "tunnels, where a step that moves builds them, and of one with; what is saved, and as a share of preprocess\n",
      options.scene.c_str(), options.width, options.height, options.view.samples, thread_count(), times.full * 1e3,
      kRounds, move.name.c_str());
  std::printf("%7s %10s %7s %10s %8s %8s %10s  %22s  %22s %8s %8s\n", "tunnels", "preprocess", "x", "stored", "disk",
              "memory", "cache B", "not stored", "stored", "saved", "share");
  for (std::size_t k = 0; k < kCounts.size(); ++k) print_line(options, kCounts[k], times.lines[k], times);
}

}  // namespace relook
