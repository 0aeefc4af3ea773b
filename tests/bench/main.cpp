// relook_bench SCENE JOURNAL [WIDTHxHEIGHT [SAMPLES]]: the measures of the project on one scene, as ratios within one
// run, beside the paper's figures (Brière & Poulin 1996, Table 3, as full render of 640 s over the time of the change).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>

#include "bare_rays.h"
#include "base/error.h"
#include "base/parallel.h"
#include "edit/apply.h"
#include "engine/render.h"
#include "engine/replay.h"
#include "scene/look.h"

namespace relook {
namespace {

using Clock = std::chrono::steady_clock;

/// The fastest of some runs, in seconds.
double fastest(int runs, const std::function<void()>& body) {
  double best = 0;
  for (int run = 0; run < runs; ++run) {
    const auto start = Clock::now();
    body();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (run == 0 || seconds < best) best = seconds;
  }
  return best;
}

struct Options {
  std::string scene, journal;
  std::uint32_t width = 1920, height = 1080;
  ViewOptions view;
};

Options parse(int count, char** arguments) {
  if (count < 3) throw UsageError("relook_bench SCENE JOURNAL|- [WIDTHxHEIGHT [SAMPLES]]");
  Options options;
  options.scene = arguments[1];
  options.journal = arguments[2];
  if (count > 3 && std::sscanf(arguments[3], "%ux%u", &options.width, &options.height) != 2)
    throw UsageError("the resolution is WIDTHxHEIGHT");
  if (count > 4) options.view.samples = static_cast<std::uint32_t>(std::strtoul(arguments[4], nullptr, 10));
  return options;
}

SceneState load(const Options& options) {
  LookDocument document = make_look_document(import_gltf(options.scene));
  const std::string choice = document.cameras.empty() ? "auto" : "";
  const Camera camera = choose_camera(document, choice, options.width, options.height);
  if (document.look.at("lights").empty()) add_auto_lights(document, camera);
  return SceneState(std::move(document), camera, std::make_shared<PyramidStore>());
}

/// What the paper reports for the steps of Table 3: full render (640 s) over the time of the change.
const char* paper_ratio(const std::string& step) {
  static const std::map<std::string, const char*> ratios = {
      {"leaves color left tree", "138 ray paths .. 2,286 color trees, 2,783 compressed"},
      {"highlight left sphere", "681 ray paths .. 5,333 color trees, 7,111 compressed"},
      {"marble color on Beethoven", "77 ray paths .. 1,829 color trees, 2,000 compressed"},
      {"ground color", "84 ray paths .. 1,362 color trees, 1,455 compressed"},
      {"index of refraction", "75 ray paths"},
      {"transform central sphere", "34 .. 82 a frame (drag, all ray trees, 1 .. 2 tunnels)"},
      {"move refractive sphere", "40 .. 53 a frame"},
      {"flying furthest tree", "34 .. 112 a frame"},
  };
  const auto it = ratios.find(step);
  return it == ratios.end() ? "-" : it->second;
}

/// Prints the full render's figures; returns the nanoseconds of one thread that a ray or shadow segment takes in it.
double print_render(const Options& options, const SceneState& state, double& full_seconds, Image& image) {
  RenderStats stats;
  double render_seconds = 0;  // without the acceleration structures, of the fastest run too
  full_seconds = fastest(5, [&] {
    stats = {};
    static_cast<void>(render(state.scene(), options.view, stats));
    if (render_seconds == 0 || stats.render_seconds < render_seconds) render_seconds = stats.render_seconds;
  });
  RenderStats kept;
  const double preprocess_seconds = fastest(3, [&] {
    kept = {};
    image = preprocess(state.scene(), options.view, kept);
  });
  const BareRays bare = time_bare_rays(state.scene(), image, 5);
  const double rays = static_cast<double>(bare.rays + bare.shadow_segments);
  std::printf("%-46s %10.3f s (acceleration structures %.3f s)\n", "full render", full_seconds, stats.build_seconds);
  std::printf("%-46s %10.2f M rays, %.2f M shadow segments\n", "rays of the full render",
              static_cast<double>(bare.rays) * 1e-6, static_cast<double>(bare.shadow_segments) * 1e-6);
  std::printf("%-46s %10.3f s, %.2f M rays/s\n", "bare Embree loop over the same rays", bare.seconds,
              rays / bare.seconds * 1e-6);
  std::printf("%-46s %10.1f %% (to reach: 70 %%)\n", "rays/s of the full render over the bare loop",
              100 * bare.seconds / render_seconds);
  std::printf("%-46s %10.2f (paper: 1.72; to reach: 1.3)\n", "preprocess / full render",
              preprocess_seconds / full_seconds);
  return render_seconds * static_cast<double>(thread_count()) / rays * 1e9;
}

void print_sizes(const Replayer& replayer, const Options& options) {
  const Resident resident = replayer.resident();
  const double samples = static_cast<double>(options.width) * options.height * options.view.samples;
  std::printf("%-46s %10zu, %.1f MB\n", "ray paths (paper, 256x256: 5,300)", replayer.image().paths.size(),
              static_cast<double>(resident.ray_paths) * 1e-6);
  std::printf("%-46s %10.1f bytes (paper: 56 to 84; to reach: 32)\n", "ray paths and ray trees, a sample",
              static_cast<double>(resident.ray_paths + resident.ray_trees) / samples);
}

void print_texture_price(const SceneState& state, double nanoseconds_per_ray) {
  for (const Material& material : state.scene().materials) {
    for (const TextureSlot& slot : material.slots) {
      if (slot.kind != TextureKind::image) continue;
      constexpr int kLookups = 1 << 20;
      float sum = 0;
      const double seconds = fastest(3, [&] {
        std::uint32_t random = 1;
        for (int i = 0; i < kLookups; ++i) {
          random = random * 1664525U + 1013904223U;
          const Uv uv(static_cast<float>(random >> 8) * 0x1p-24F, static_cast<float>(random & 0xFFFFU) * 0x1p-16F);
          sum += sample(*slot.pyramid, uv, 1.5F, slot.wrap_s, slot.wrap_t, slot.nearest).r;
        }
      });
      std::printf("%-46s %10.1f ns; a ray %.1f ns of one thread (sum %g)\n", "trilinear lookup, random places",
                  seconds / kLookups * 1e9, nanoseconds_per_ray, static_cast<double>(sum));
      return;
    }
  }
}

void print_steps(Replayer& replayer, const Options& options, double full_seconds) {
  const Journal journal = read_journal(options.journal);
  std::printf("\n%-28s %-9s %9s %9s %9s  %9s  %s\n", "step", "class", "affected", "changed", "ms", "full/edit",
              "paper");
  for (const JournalStep& step : journal.steps) {
    std::vector<Edit> edits = step.drag;
    if (edits.empty()) edits.push_back(step.edit);
    for (const Edit& edit : edits) {
      const auto start = Clock::now();
      const StepResult result = replayer.step(edit, journal.file, journal.path.parent_path());
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      const double total = static_cast<double>(result.counters.samples_total);
      std::printf("%-28.28s %-9s %8.1f%% %9zu %9.2f  %9.0f  %s\n", step.name.c_str(),
                  std::string(change_class_name(result.classification.change)).c_str(),
                  100 * static_cast<double>(result.counters.samples_affected) / total, result.changed_pixels.size(),
                  seconds * 1e3, full_seconds / seconds, paper_ratio(step.name));
    }
  }
}

void run(const Options& options) {
  SceneState state = load(options);
  std::printf("relook_bench: %s at %ux%u, %u sample(s), %zu thread(s), %zu objects\n", options.scene.c_str(),
              options.width, options.height, options.view.samples, thread_count(), state.scene().objects.size());
  double full_seconds = 0;
  Image image;
  const double ray_nanoseconds = print_render(options, state, full_seconds, image);
  print_texture_price(state, ray_nanoseconds);
  Replayer replayer(std::move(state), std::move(image));
  print_sizes(replayer, options);
  if (options.journal != "-") print_steps(replayer, options, full_seconds);
}

}  // namespace
}  // namespace relook

int main(int count, char** arguments) {
  try {
    relook::run(relook::parse(count, arguments));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "relook_bench: %s\n", error.what());
    return 2;
  }
}
