#include "replay/journal_replay.h"

#include <algorithm>
#include <utility>

namespace relook {
namespace {

/// A number or a few instead of another: nothing else in the document follows from it.
bool replaces_number(const PatchOperation& operation) {
  const Json& value = operation.value;
  return operation.op == PatchOp::replace &&
         (value.is_number() || (value.is_array() && !value.empty() && std::ranges::all_of(value, &Json::is_number)));
}

/// Whether the state after two frames of a step, one after the other, is that after the second alone.
bool is_overtaken(const JournalEvent& first, const JournalEvent& second) {
  if (first.step != second.step) return false;
  const Edit a = first.edit(), b = second.edit();
  return std::ranges::equal(a, b, [](const PatchOperation& one, const PatchOperation& other) {
    return one.path == other.path && replaces_number(one) && replaces_number(other);
  });
}

/// One result for two updates of an image, one after the other.
StepResult joined(const StepResult& first, StepResult second) {
  const std::uint64_t samples = second.counters.samples_total;
  second.counters += first.counters;
  second.counters.samples_total = samples;
  second.counters.samples_affected = std::min(second.counters.samples_affected, samples);
  second.seconds.classify += first.seconds.classify;
  second.seconds.select += first.seconds.select;
  second.seconds.test += first.seconds.test;
  second.seconds.update += first.seconds.update;
  second.seconds.evaluate += first.seconds.evaluate;
  second.changed_pixels.merge(first.changed_pixels);
  return second;
}

}  // namespace

JournalReplay::JournalReplay(const Journal& journal, Replayer& replayer)
    : journal_(journal), replayer_(replayer), history_(journal) {
  for (std::uint32_t step = 1; step <= journal.steps.size(); ++step)
    if (const std::uint32_t start = state_before(journal, step); start + 1 != step) last_uses_[start] = step;
  if (last_uses_.contains(0)) starts_[0] = replayer.image().frame;
}

/// Keeps the frame of a state to which later steps go back, and forgets those to which none does any more.
void JournalReplay::end_event(const JournalEvent& event) {
  if (!event.has_frame() || !event.is_last_frame()) return;
  const std::uint32_t step = event.place.step;
  if (last_uses_.contains(step)) starts_[step] = replayer_.image().frame;
  std::erase_if(starts_, [&](const auto& start) { return last_uses_.at(start.first) <= step; });
}

void JournalReplay::catch_up() {
  if (waiting_.empty()) return;
  const std::vector<JournalEvent> events = std::exchange(waiting_, {});
  static_cast<void>(replayer_.step([&](SceneState& state) {
    EditedScene all;
    for (const JournalEvent& event : events) {
      EditedScene edited = apply_event(state, journal_, event, history_);
      all.delta = merged(std::move(all.delta), std::move(edited.delta), state.scene());
      all.classification = std::move(edited.classification);
    }
    return all;
  }));
  end_event(events.back());
}

void JournalReplay::skip(const JournalEvent& event) {
  if (event.kind == EventKind::base || !event.has_frame()) return;
  if (is_dragging_) {
    static_cast<void>(drag(event));
    return end_event(event);
  }
  JournalEvent next = event;
  if (!waiting_.empty() && is_overtaken(waiting_.back(), next)) {
    next.back_to = waiting_.back().back_to;
    waiting_.pop_back();
  }
  waiting_.push_back(next);
  if (event.is_last_frame() && last_uses_.contains(event.place.step)) catch_up();
}

/// What is dragged is lifted out of the scene that the step starts in.
StepResult JournalReplay::drag(const JournalEvent& event) {
  is_dragging_ = true;
  StepResult back;
  if (event.back_to)
    back = replayer_.step([&](SceneState& state) {
      return EditedScene{go_back(state, journal_, event, history_), {}};
    });
  StepResult result = replayer_.drag([&](SceneState& state) { return make_edit(state, journal_, event, history_); });
  return event.back_to ? joined(back, std::move(result)) : result;
}

StepResult JournalReplay::follow(const JournalEvent& event) {
  catch_up();
  StepResult result;
  switch (event.kind) {
    case EventKind::base:
    case EventKind::wedge_end:
      return result;
    case EventKind::edit:
      result = replayer_.step([&](SceneState& state) { return apply_event(state, journal_, event, history_); });
      break;
    case EventKind::drag:
      result = drag(event);
      break;
    case EventKind::release:
      if (std::exchange(is_dragging_, false)) result = replayer_.release();
      return result;
  }
  changed_in_step_ =
      event.back_to ? pixels_between(starts_.at(*event.back_to), replayer_.image().frame) : result.changed_pixels;
  result.counters.pixels_changed = changed_in_step_.size();
  end_event(event);
  return result;
}

}  // namespace relook
