// What every measure of the benchmark needs: its options, the scene ready to be edited, and times.
#pragma once
#include <functional>
#include <string>

#include "edit/journal.h"
#include "frame/image.h"
#include "record.h"
#include "replay/replay.h"
#include "scene/compile/state.h"

namespace relook {

struct BenchOptions {
  std::string scene, journal;  // journal "-": none
  std::string camera;          // as --camera of the program names it; "": the scene's first one, or one that frames all
  std::uint32_t width = 1920, height = 1080;
  ViewOptions view;
  Record* record = nullptr;  // gets what note() is told, if there is one

  void note(std::string table, std::string row, std::string column, double value, std::string unit = "",
            std::string paper = "", std::optional<Goal> goal = std::nullopt) const;
  [[nodiscard]] double pixels() const { return static_cast<double>(width) * height; }
  [[nodiscard]] double samples() const { return pixels() * view.samples; }
};

/// `words`: SCENE JOURNAL [WIDTHxHEIGHT [SAMPLES]] [--camera CAMERA]; `width`, `height`: without a size. Throws
/// UsageError.
[[nodiscard]] BenchOptions parse_options(const std::vector<std::string>& words, std::uint32_t width = 1920,
                                         std::uint32_t height = 1080);

[[nodiscard]] LookDocument import_look(const BenchOptions& options);
/// What the program is told of a scene beside its file.
struct SceneChoices {
  std::string camera;            // "": the scene's first one
  bool has_auto_lights = false;  // there are none in the scene
};
[[nodiscard]] SceneChoices scene_choices(const BenchOptions& options, const LookDocument& document);
[[nodiscard]] SceneState load_scene(const BenchOptions& options);

/// The time of one call, and of the fastest of some calls, in seconds.
[[nodiscard]] double time_of(const std::function<void()>& body);
[[nodiscard]] double fastest(int runs, const std::function<void()>& body);

/// A step of a replay and its time as the caller sees it.
struct TimedStep {
  StepResult result;
  double seconds = 0;
};
enum class StepKind : std::uint8_t { step, drag };
/// `journal`: whose folder holds what the edit names.
[[nodiscard]] TimedStep timed(Replayer& replayer, StepKind kind, const Edit& edit, const Journal& journal);
[[nodiscard]] TimedStep timed_release(Replayer& replayer);
/// Keeps the faster of two runs of one step.
void keep_faster(TimedStep& best, TimedStep step);

/// All operations of a step, a drag's entries one after the other.
[[nodiscard]] Edit whole_edit(const JournalStep& step);
/// The edit that gives the values that `look` has back. Requires: operations add, remove, replace and test only, on
/// paths as the look document spells them.
[[nodiscard]] Edit inverse_of(const Edit& edit, const Json& look);

}  // namespace relook
