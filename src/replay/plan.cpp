#include "replay/plan.h"

#include <algorithm>
#include <cmath>

#include "replay/journal_replay.h"

namespace relook {
namespace {

/// Pixels of the larger proxy: a sixteenth of the image's, but enough for counts to be within a few percent, and never
/// more than a quarter.
double proxy_pixels(double pixels) {
  constexpr double kEnough = 16384;
  return std::min(std::max(pixels / 16, kEnough), pixels / 4);
}

/// The same view with about `pixels` pixels.
Camera shrunk(Camera camera, double pixels) {
  const double scale = std::sqrt(pixels / (static_cast<double>(camera.width) * camera.height));
  const auto side = [&](std::uint32_t full) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(full * scale)));
  };
  camera.width = side(camera.width);
  camera.height = side(camera.height);
  return camera;
}

double seconds_of(const Seconds& seconds) {
  return seconds.classify + seconds.select + seconds.test + seconds.update + seconds.evaluate;
}

/// Replays a journal as JournalRun does, and notes its frames.
class ProxyReplay {
 public:
  ProxyReplay(SceneState state, const ViewOptions& view) : replayer_(replayer_of(std::move(state), view)) {}

  std::vector<PlannedFrame> run(const Journal& journal, const Progress& progress) {
    JournalReplay replay(journal, replayer_);
    for (const JournalEvent& event : JournalWalk(journal)) {
      if (progress && event.is_first_frame())
        progress(static_cast<double>(event.place.step - 1) / static_cast<double>(journal.steps.size()));
      const StepResult result = replay.follow(event);
      if (event.kind != EventKind::base) note(journal, event, result);
    }
    return std::move(frames_);
  }

 private:
  static Replayer replayer_of(SceneState state, const ViewOptions& view) {
    RenderStats stats;
    Image image = preprocess(state.scene(), view, stats);
    return {std::move(state), std::move(image)};
  }

  void note(const Journal& journal, const JournalEvent& event, const StepResult& result) {
    PlannedFrame frame;
    frame.place = event.place;
    frame.is_whole_step = !event.has_frame();
    frame.name = event.step->name;
    frame.from = state_before(journal, event.place.step);
    frame.classification = result.classification;
    if (event.is_first_frame()) step_class_ = ChangeClass::color;
    if (frame.is_whole_step) frame.classification.change = step_class_;
    step_class_ = combined(step_class_, frame.classification.change);
    frame.samples_affected = result.counters.samples_affected;
    frame.pixels_changed = result.counters.pixels_changed;
    frame.seconds = seconds_of(result.seconds);
    frame.resident_bytes = replayer_.resident().total;
    frames_.push_back(std::move(frame));
  }

  Replayer replayer_;
  ChangeClass step_class_ = ChangeClass::color;  // of the present step's frames so far
  std::vector<PlannedFrame> frames_;
};

/// The line through two measurements, at `x`; neither part of it shrinks what was measured at the larger one.
double extrapolated(double x0, double y0, double x1, double y1, double x) {
  const double slope = std::clamp((y1 - y0) / (x1 - x0), 0.0, y1 / x1);
  return y1 + slope * (x - x1);
}

std::uint64_t scaled(std::uint64_t count, double ratio, double most) {
  return static_cast<std::uint64_t>(std::llround(std::min(static_cast<double>(count) * ratio, most)));
}

}  // namespace

Plan plan_replay(const LookDocument& document, const Camera& camera, const std::shared_ptr<PyramidStore>& pyramids,
                 const ViewOptions& view, const Journal& journal, const Progress& progress) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const Camera large = shrunk(camera, proxy_pixels(pixels)), small = shrunk(camera, proxy_pixels(pixels) / 4);
  const auto replay = [&](const Camera& proxy, double first, double share) {
    LookDocument copy = document;  // a journal may add assets to its own
    copy.assets = std::make_shared<Assets>(*document.assets);
    const Progress part = [&](double done) {
      if (progress) progress(first + share * done);
    };
    return ProxyReplay(SceneState(std::move(copy), proxy, pyramids, view.integrator), view).run(journal, part);
  };
  const std::vector<PlannedFrame> few = replay(small, 0, 0.2);
  Plan plan;
  plan.frames = replay(large, 0.2, 0.8);
  plan.proxy_width = large.width;
  plan.proxy_height = large.height;
  plan.samples_total = static_cast<std::uint64_t>(pixels) * view.samples;
  const double few_pixels = static_cast<double>(small.width) * small.height,
               proxy = static_cast<double>(large.width) * large.height;
  for (std::size_t i = 0; i < plan.frames.size(); ++i) {
    PlannedFrame& frame = plan.frames[i];
    frame.samples_affected = scaled(frame.samples_affected, pixels / proxy, static_cast<double>(plan.samples_total));
    frame.pixels_changed = scaled(frame.pixels_changed, pixels / proxy, pixels);
    if (few_pixels == proxy) continue;
    frame.seconds = extrapolated(few_pixels, few[i].seconds, proxy, frame.seconds, pixels);
    frame.resident_bytes =
        static_cast<std::uint64_t>(extrapolated(few_pixels, static_cast<double>(few[i].resident_bytes), proxy,
                                                static_cast<double>(frame.resident_bytes), pixels));
  }
  return plan;
}

}  // namespace relook
