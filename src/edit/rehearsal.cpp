// A journal tried out on the scene and taken back: what is wrong with it is known before anything is written. A step
// that is wrong leaves nothing behind, so that the next ones are judged by what they say themselves; one that builds on
// what a wrong step was to add is wrong, too.
#include <algorithm>

#include "edit/apply.h"
#include "edit/guide/path_hints.h"
#include "edit/journal_walk.h"
#include "edit/scene_history.h"
#include "edit/step_errors.h"
#include "edit/transaction.h"

namespace relook {
namespace {

bool is_guard(const JournalStep& step) {
  bool has_operations = false;
  for (std::size_t frame = 0; frame < step.frames(); ++frame)
    for (const PatchOperation& operation : step.edit_of(frame)) {
      if (operation.op != PatchOp::test) return false;
      has_operations = true;
    }
  return has_operations;
}

class Rehearsal {
 public:
  Rehearsal(SceneState& state, const Journal& journal)
      : state_(state),
        journal_(journal),
        counts_(state.slot_counts()),
        done_(state, journal.file, journal.path.parent_path()),
        errors_(journal.file),
        history_(journal) {}

  /// Whether at least one step changes more than colours. Requires a journal without errors.
  [[nodiscard]] bool finds_class_beyond_color() {
    notes_classes_ = true;
    static_cast<void>(run());
    return is_beyond_color_;
  }

  /// Whether at least one step changes a value of the scene. Requires a journal without errors.
  [[nodiscard]] bool finds_change() {
    static_cast<void>(run());
    return is_change_;
  }

  std::vector<std::string> run() {
    try {
      for (std::uint32_t step = 1; step <= journal_.steps.size(); ++step) try_step(step);
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
    for (std::string& slip : slip_warnings(journal_)) warnings_.push_back(std::move(slip));
    return std::move(warnings_);
  }

 private:
  void try_step(std::uint32_t number) {
    Transaction transaction(state_, journal_.file, journal_.path.parent_path());
    transaction.count_after(done_);
    bool changes_scene = false;
    try {
      const bool is_sound = errors_.is_sound([&] {
        follow_edits(JournalWalk(journal_, number, number), [&](const JournalEvent& event) {
          if (event.back_to) note(transaction.restore(history_.values_at(*event.back_to, state_.document())));
          if (event.kind == EventKind::drag) check_drag_scope(state_, *event.step, event.frame, journal_.file);
          const SceneDelta delta = transaction.apply(event.edit());
          changes_scene = changes_scene || !delta.empty();
          note(delta);
        });
      });
      if (!is_sound) {
        transaction.undo();
        return history_.end_step(number, state_.document());
      }
    } catch (...) {
      transaction.undo();
      throw;
    }
    is_change_ = is_change_ || changes_scene;
    const JournalStep& step = journal_.steps[number - 1];
    if (!changes_scene && !is_guard(step)) warn(step, transaction.has_changes());
    if (const std::uint32_t start = state_before(journal_, number); start + 1 != number) history_.went_back(start);
    history_.note(transaction);
    history_.end_step(number, state_.document());
    done_.absorb(std::move(transaction));
  }

  void note(const SceneDelta& delta) {
    if (notes_classes_ && !is_beyond_color_)
      is_beyond_color_ = classify(state_.scene(), delta).change != ChangeClass::color;
  }

  void warn(const JournalStep& step, bool changes_document) {
    if (++idle_steps_ > kMostNamedSteps) return;
    warnings_.push_back(journal_.file + ": " + step.where + ": \"" + step.name + "\" changes nothing" +
                        (changes_document ? " that the scene shows" : ""));
  }

  void take_back_all() {
    done_.undo();
    state_.drop_slots_after(counts_);
  }

  SceneState& state_;
  const Journal& journal_;
  const SlotCounts counts_;
  Transaction done_;  // all sound steps so far
  StepErrors errors_;
  SceneHistory history_;
  std::vector<std::string> warnings_;
  std::size_t idle_steps_ = 0;  // that change nothing
  bool notes_classes_ = false, is_beyond_color_ = false, is_change_ = false;
};

}  // namespace

std::vector<std::string> check_journal(SceneState& state, const Journal& journal) {
  return Rehearsal(state, journal).run();
}

bool changes_scene(SceneState& state, const Journal& journal) { return Rehearsal(state, journal).finds_change(); }

bool shoots_rays(SceneState& state, const Journal& journal) {
  return Rehearsal(state, journal).finds_class_beyond_color();
}

}  // namespace relook
