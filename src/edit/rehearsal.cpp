// A journal tried out on the scene and taken back: what is wrong with it is known before anything is written. A step
// that is wrong leaves nothing behind, so that the next ones are judged by what they say themselves; one that builds on
// what a wrong step was to add is wrong, too.
#include <algorithm>
#include <memory>

#include "edit/apply.h"
#include "edit/step_errors.h"
#include "edit/transaction.h"

namespace relook {
namespace {

bool is_guard(std::span<const Edit> frames) {
  bool has_operations = false;
  for (const Edit& edit : frames)
    for (const PatchOperation& operation : edit) {
      if (operation.op != PatchOp::test) return false;
      has_operations = true;
    }
  return has_operations;
}

class Rehearsal {
 public:
  Rehearsal(SceneState& state, const Journal& journal)
      : state_(state), journal_(journal), counts_(state.slot_counts()), errors_(journal.file) {}

  /// Requires a journal without errors. Of one step at least: not only colours change.
  [[nodiscard]] bool finds_class_beyond_color() {
    notes_classes_ = true;
    static_cast<void>(run());
    return is_beyond_color_;
  }

  std::vector<std::string> run() {
    try {
      for (const JournalStep& step : journal_.steps) try_step(step);
    } catch (...) {
      take_back_all();
      throw;
    }
    take_back_all();
    errors_.require_none();
    if (idle_steps_ > kMostNamedSteps) {
      const std::size_t more = idle_steps_ - kMostNamedSteps;
      warnings_.push_back(journal_.file + ": " + std::to_string(more) +
                          (more == 1 ? " more step changes nothing" : " more steps change nothing"));
    }
    return std::move(warnings_);
  }

 private:
  void try_step(const JournalStep& step) {
    const std::span<const Edit> frames = frames_of(step);
    const std::size_t before = done_.size();
    bool changes_scene = false, changes_document = false;
    const bool is_sound = errors_.is_sound([&] {
      for (std::size_t entry = 0; entry < frames.size(); ++entry) {
        if (!step.drag.empty()) check_drag_scope(state_, step, entry, journal_.file);
        auto transaction = std::make_unique<Transaction>(state_, journal_.file, journal_.path.parent_path());
        const SceneDelta delta = transaction->apply(frames[entry]);
        changes_scene = changes_scene || !delta.empty();
        if (notes_classes_ && !is_beyond_color_)
          is_beyond_color_ = classify(state_.scene(), delta).change != ChangeClass::color;
        changes_document = changes_document || (delta.empty() && transaction->has_changes());
        done_.push_back(std::move(transaction));
      }
    });
    if (!is_sound)
      take_back(before);
    else if (!changes_scene && !is_guard(frames))
      warn(step, changes_document);
  }

  void warn(const JournalStep& step, bool changes_document) {
    if (++idle_steps_ > kMostNamedSteps) return;
    warnings_.push_back(journal_.file + ": " + step.where + ": \"" + step.name + "\" changes nothing" +
                        (changes_document ? " that the scene shows" : ""));
  }

  void take_back(std::size_t count) {
    for (; done_.size() > count; done_.pop_back()) done_.back()->undo();
  }
  void take_back_all() {
    take_back(0);
    state_.drop_slots_after(counts_);
  }

  SceneState& state_;
  const Journal& journal_;
  const SlotCounts counts_;
  std::vector<std::unique_ptr<Transaction>> done_;
  StepErrors errors_;
  std::vector<std::string> warnings_;
  std::size_t idle_steps_ = 0;  // that change nothing
  bool notes_classes_ = false, is_beyond_color_ = false;
};

}  // namespace

std::vector<std::string> check_journal(SceneState& state, const Journal& journal) {
  return Rehearsal(state, journal).run();
}

bool shoots_rays(SceneState& state, const Journal& journal) {
  return Rehearsal(state, journal).finds_class_beyond_color();
}

}  // namespace relook
