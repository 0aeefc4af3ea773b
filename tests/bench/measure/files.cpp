#include "files.h"

#include <algorithm>
#include <cstdio>

#include "bench_cache.h"
#include "frame/frame_file.h"
#include "image/render.h"

namespace relook {
namespace {

constexpr int kRuns = 5;
constexpr double kMostShare = 0.1;  // of the pixels, of the edits that are looked at

/// A full render and its frame, written afresh.
double full_with_file(const SceneState& state, const ViewOptions& view, const std::filesystem::path& file) {
  return fastest(kRuns, [&] {
    RenderStats stats;
    write_file(file, encode_exr(render(state.scene(), view, stats), {}, PixelFormat::half));
  });
}

/// An edit and its frame, of which only the tiles that change are compressed; the edit is taken back each time.
struct EditTime {
  double seconds = 0, share = 0;
};
EditTime edit_with_file(Replayer& replayer, FrameEncoder& encoder, const Edit& edit, const Edit& inverse,
                        const Journal& journal, const std::filesystem::path& file) {
  const Frame& frame = replayer.image().frame;
  EditTime best;
  for (int run = 0; run <= kRuns; ++run) {
    double share = 0;
    const double seconds = time_of([&] {
      const TimedStep step = timed(replayer, StepKind::step, edit, journal);
      share = static_cast<double>(step.result.changed_pixels.size()) / static_cast<double>(frame.pixels.size());
      encoder.update(frame, step.result.changed_pixels);
      write_file(file, encoder.exr({}));
    });
    encoder.update(frame, timed(replayer, StepKind::step, inverse, journal).result.changed_pixels);
    static_cast<void>(encoder.exr({}));
    if (run > 0 && (best.seconds == 0 || seconds < best.seconds)) best = {seconds, share};  // the first one compresses
  }
  return best;
}

/// From the start of the process to its end: the cache read, the frame before and after the edit written, and previews.
double start_to_frame(const BenchOptions& options, const JournalStep& step, const ScratchFolder& folder) {
  write_bench_cache(options, folder / "cache");
  Json edit = Json::array();
  for (const PatchOperation& operation : step.edit)
    edit.push_back({{"op", "replace"}, {"path", operation.path}, {"value", operation.value}});
  const Json journal{{"relook", "journal/1"}, {"steps", {{{"name", step.name}, {"edit", edit}}}}};
  write_file(folder / "first.json", journal.dump());
  const std::vector<std::string> command{RELOOK_PROGRAM,
                                         "replay",
                                         (folder / "cache").string(),
                                         (folder / "first.json").string(),
                                         "-o",
                                         (folder / "run").string(),
                                         "--steps",
                                         "1",
                                         "--quiet",
                                         "--fresh"};
  return fastest(kRuns, [&] { run_program(command); });
}

}  // namespace

void print_files(const BenchOptions& options, const Image& image, const Journal& journal) {
  const ScratchFolder folder;
  Replayer replayer(load_scene(options), image);
  const double full_seconds = full_with_file(replayer.state(), options.view, folder / "full.exr");
  std::printf("\n%-46s %10.3f s\n", "full render and its EXR frame", full_seconds);
  FrameEncoder encoder(options.width, options.height, PixelFormat::half);
  encoder.update(replayer.image().frame);
  static_cast<void>(encoder.exr({}));
  const JournalStep* first = nullptr;
  for (const JournalStep& step : journal.steps) {
    const bool is_plain = std::ranges::all_of(step.edit, [](const auto& one) { return one.op == PatchOp::replace; });
    if (step.edit.empty() || !is_plain) continue;
    const Edit inverse = inverse_of(step.edit, replayer.state().document().look);
    const TimedStep once = timed(replayer, StepKind::step, step.edit, journal);
    encoder.update(replayer.image().frame, once.result.changed_pixels);
    if (once.result.classification.change != ChangeClass::color) continue;
    encoder.update(replayer.image().frame, timed(replayer, StepKind::step, inverse, journal).result.changed_pixels);
    if (first == nullptr) first = &step;
    const EditTime edit = edit_with_file(replayer, encoder, step.edit, inverse, journal, folder / "edit.exr");
    if (edit.share == 0 || edit.share > kMostShare) continue;
    std::printf("%-46.46s %10.2f ms, %.1f %% of the pixels, full / edit %.0f (to reach: 100)\n",
                (step.name + " and its EXR frame").c_str(), edit.seconds * 1e3, 100 * edit.share,
                full_seconds / edit.seconds);
    options.note("With files", step.name, "full render + EXR / edit + EXR", full_seconds / edit.seconds, "", "",
                 Goal{100});
  }
  if (first == nullptr) return;
  const double seconds = start_to_frame(options, *first, folder);
  std::printf("%-46s %10.3f s (to reach: 0.5)\n", "start to first edited frame, whole process", seconds);
  options.note("With files", first->name, "start to first edited frame", seconds, "s", "", Goal{0.5, true});
}

}  // namespace relook
