#include "light.h"

#include <algorithm>
#include <cstdio>

#include "bare_rays.h"
#include "frame/frame_file.h"
#include "image/render.h"

namespace relook {
namespace {

std::uint64_t vertices_of(const Image& image) {
  std::uint64_t hits = 0;
  for (const TileTrees& tile : image.trees) hits += tile.hits.size();
  return hits;
}

void print_memory(const Image& image, const Resident& resident) {
  const auto vertices = static_cast<double>(vertices_of(image));
  std::printf("%-46s %10.1f (%.1f M hits; %zu paths)\n", "bytes a hit: paths and ray trees",
              static_cast<double>(resident.ray_paths + resident.ray_trees) / vertices, vertices / 1e6,
              image.paths.size());
  std::printf("%-46s %10.1f\n", "bytes a pixel: sums of light",
              static_cast<double>(resident.light_sums) / static_cast<double>(image.frame.pixels.size()));
}

/// The frames of a step: its edit, or one for each entry of a drag or value of a wedge.
std::vector<Edit> edits_of(const JournalStep& step) {
  if (!step.drag.empty()) return step.drag;
  return {step.edit};
}

/// What a full render and the encoding of its frame take.
struct FullSeconds {
  double render = 0, frame = 0;
};

void print_step(const BenchOptions& options, Replayer& replayer, const Journal& journal, const JournalStep& step,
                const FullSeconds& full) {
  const std::vector<Edit> edits = edits_of(step);
  const Edit inverse = inverse_of(edits.front(), replayer.state().document().look);
  const TimedStep first = timed(replayer, StepKind::step, edits.front(), journal);
  static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
  const TimedStep later = timed(replayer, StepKind::step, edits.front(), journal);
  for (std::size_t i = 1; i < edits.size(); ++i) static_cast<void>(timed(replayer, StepKind::step, edits[i], journal));
  const Counters& counters = later.result.counters;
  const double terms = static_cast<double>(replayer.resident().kept_terms) /
                       std::max(1.0, static_cast<double>(counters.samples_affected));
  std::printf("  %-34s %-10s %9.1f %9.1f %9.1f %8.1f %% %8.1f %% %9.0f\n", step.name.substr(0, 34).c_str(),
              std::string(change_class_name(first.result.classification.change)).c_str(), full.render / first.seconds,
              full.render / later.seconds, (full.render + full.frame) / (later.seconds + full.frame),
              100.0 * static_cast<double>(counters.samples_affected) / static_cast<double>(counters.samples_total),
              100.0 * static_cast<double>(counters.pixels_changed) / options.pixels(), terms);
  options.note("Light", step.name, "full render / later edit", full.render / later.seconds);
}

}  // namespace

void print_light(const BenchOptions& given) {
  BenchOptions options = given;
  options.view.integrator = Integrator::path;
  if (options.view.samples == 1) options.view.samples = 64;
  SceneState state = load_scene(options);
  std::printf("%s %ux%u, %u samples a pixel\n", options.scene.c_str(), options.width, options.height,
              options.view.samples);
  RenderStats stats;
  const double full_seconds = time_of([&] { static_cast<void>(render(state.scene(), options.view, stats)); });
  RenderStats kept;
  Image image;
  const double preprocess_seconds = time_of([&] { image = preprocess(state.scene(), options.view, kept); });
  const BareRays bare = time_bare_rays(state.scene(), image, 2);
  std::printf("%-46s %10.2f s\n", "full render", full_seconds);
  std::printf("%-46s %10.2f\n", "preprocess / full render", preprocess_seconds / full_seconds);
  std::printf("%-46s %10.0f %% (%.0f M rays, %.0f M shadow segments)\n", "full render's rays a second / bare loop",
              100 * bare.seconds / full_seconds, static_cast<double>(bare.rays) / 1e6,
              static_cast<double>(bare.shadow_segments) / 1e6);
  options.note("Light", "full render", "rays a second / bare loop", bare.seconds / full_seconds, "", "", Goal{0.7});
  options.note("Light", "preprocess", "preprocess / full render", preprocess_seconds / full_seconds, "", "",
               Goal{1.3, true});
  const auto replayer = std::make_unique<Replayer>(std::move(state), std::move(image));
  print_memory(replayer->image(), replayer->resident());
  if (options.journal == "-") return;
  const Journal journal = read_journal(options.journal);
  FullSeconds full{full_seconds, 0};
  full.frame = time_of([&] { static_cast<void>(encode_exr(replayer->image().frame, {}, PixelFormat::half)); });
  std::printf("  %-34s %-10s %9s %9s %9s %10s %10s %9s\n", "edit", "class", "full/1st", "full/2nd", "with EXR",
              "samples", "pixels", "kept B");
  for (const JournalStep& step : journal.steps) print_step(options, *replayer, journal, step, full);
}

}  // namespace relook
