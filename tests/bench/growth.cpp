#include "growth.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "image/render.h"

namespace relook {
namespace {

struct Size {
  std::uint32_t width = 0, height = 0;
};
constexpr std::array<Size, 3> kSizes{Size{422, 237}, Size{1333, 750}, Size{3771, 2121}};  // 0.1, 1, 8 million samples
constexpr std::array<const char*, 3> kSteps{"leaves color left tree", "index of refraction", "flying furthest tree"};
constexpr int kRuns = 3;

const JournalStep& step_named(const Journal& journal, const std::string& name) {
  for (const JournalStep& step : journal.steps)
    if (step.name == name) return step;
  throw InputError(journal.file, "/steps", "no step \"" + name + "\"");
}

/// The fastest of some runs of an edit, after one that lets all structures be built; the edit is taken back each time.
TimedStep time_edit(Replayer& replayer, const Edit& edit, const Journal& journal) {
  const Edit inverse = inverse_of(edit, replayer.state().document().look);
  TimedStep best;
  for (int run = 0; run <= kRuns; ++run) {
    TimedStep once = timed(replayer, StepKind::step, edit, journal);
    static_cast<void>(timed(replayer, StepKind::step, inverse, journal));
    if (run > 0) keep_faster(best, std::move(once));
  }
  return best;
}

Box scene_bounds(const Scene& scene) {
  Box box;
  for (const Object& object : scene.objects) {
    const Box& local = scene.mesh(object.mesh).bounds;
    for (unsigned corner = 0; corner < 8 && object.alive && !local.isEmpty(); ++corner) {
      const Point at((corner & 1U) != 0 ? local.max.x : local.min.x, (corner & 2U) != 0 ? local.max.y : local.min.y,
                     (corner & 4U) != 0 ? local.max.z : local.min.z);
      box.extendBy(at * object.to_world);
    }
  }
  return box;
}

Edit one_operation(PatchOp op, const std::string& path, Json value) {
  PatchOperation operation;
  operation.op = op;
  operation.path = path;
  operation.value = std::move(value);
  return {operation};
}

/// Adds a small object far below everything, and times moving it.
TimedStep time_unseen(Replayer& replayer, const Journal& journal) {
  const std::string path = "/nodes/relook_bench_unseen";
  const Box box = scene_bounds(replayer.state().scene());
  const Point middle = box.center();
  const float below = box.min.y - 10 * (box.size().length() + 1);
  const Json node = {{"mesh", replayer.state().document().look.at("meshes").begin().key()},
                     {"translation", {middle.x, below, middle.z}},
                     {"scale", {1e-3, 1e-3, 1e-3}}};
  static_cast<void>(timed(replayer, StepKind::step, one_operation(PatchOp::add, path, node), journal));
  const Json aside = {middle.x + 0.01F, below, middle.z};
  return time_edit(replayer, one_operation(PatchOp::replace, path + "/translation", aside), journal);
}

void print_edit(const BenchOptions& options, const char* name, const TimedStep& step) {
  const auto affected = static_cast<double>(step.result.counters.samples_affected);
  std::printf("  %-30s %10.0f %10.2f", name, affected, step.seconds * 1e3);
  if (affected > 0) std::printf(" %10.0f", step.seconds / affected * 1e9);
  const std::string size = std::to_string(options.width) + "x" + std::to_string(options.height);
  if (affected > 0)
    options.note("Growth", name, size, step.seconds / affected * 1e9, "ns an affected sample");
  else
    options.note("Growth", name, size, step.seconds * 1e3, "ms", "", Goal{1, true});
  std::printf("\n");
}

/// By edit: nanoseconds an affected sample, of each size.
using Growth = std::map<std::string, std::vector<double>>;

void print_size(const BenchOptions& options, const Journal& journal, Growth& growth) {
  SceneState state = load_scene(options);
  RenderStats stats;
  Image image = preprocess(state.scene(), options.view, stats);
  Replayer replayer(std::move(state), std::move(image));
  std::printf("%ux%u, %.1f M samples\n", options.width, options.height, options.samples() * 1e-6);
  for (const char* name : kSteps) {
    const TimedStep step = time_edit(replayer, whole_edit(step_named(journal, name)), journal);
    print_edit(options, name, step);
    growth[name].push_back(step.seconds / static_cast<double>(step.result.counters.samples_affected) * 1e9);
  }
  print_edit(options, "move of something unseen", time_unseen(replayer, journal));
}

}  // namespace

void print_growth(const BenchOptions& options) {
  const Journal journal = read_journal(options.journal);
  std::printf(
      "relook_bench growth: %s, %zu thread(s); fastest of %d. To reach: ns a sample constant within 20 %%, the "
      "unseen move under 1 ms\n",
      options.scene.c_str(), thread_count(), kRuns);
  std::printf("  %-30s %10s %10s %10s\n", "edit", "affected", "ms", "ns/sample");
  Growth growth;
  for (const Size& size : kSizes) {
    BenchOptions sized = options;
    sized.width = size.width;
    sized.height = size.height;
    print_size(sized, journal, growth);
  }
  for (const auto& [name, prices] : growth)
    options.note("Growth", name, "dearest / cheapest sample",
                 *std::ranges::max_element(prices) / *std::ranges::min_element(prices), "", "", Goal{1.2, true});
}

}  // namespace relook
