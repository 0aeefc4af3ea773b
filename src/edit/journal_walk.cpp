#include "edit/journal_walk.h"

namespace relook {
namespace {

EventKind kind_of_frame(StepForm form) {
  switch (form) {
    case StepForm::edit:
    case StepForm::wedge:
      return EventKind::edit;
    case StepForm::drag:
      break;
  }
  return EventKind::drag;
}

EventKind kind_of_end(StepForm form) { return form == StepForm::drag ? EventKind::release : EventKind::wedge_end; }

}  // namespace

JournalEvent JournalWalk::Iterator::operator*() const {
  if (step_ == 0) return {};
  const JournalStep& step = journal_->steps[step_ - 1];
  const std::size_t frames = step.frames();
  const bool is_end = event_ == frames;
  const std::size_t frame = is_end ? frames - 1 : event_;
  JournalEvent event{is_end ? kind_of_end(step.form()) : kind_of_frame(step.form()), place_of(*journal_, step_, frame),
                     frame, &step, std::nullopt};
  if (const std::uint32_t start = state_before(*journal_, step_); event_ == 0 && start + 1 != step_)
    event.back_to = start;
  return event;
}

JournalWalk::Iterator& JournalWalk::Iterator::operator++() {
  const std::size_t events = frames_in(*journal_, step_) + (is_numbered(*journal_, step_) ? 1 : 0);
  if (++event_ < events) return *this;
  ++step_;
  event_ = 0;
  return *this;
}

std::uint32_t state_before(const Journal& journal, std::uint32_t step) {
  return state_after(journal, journal.steps[step - 1].from.value_or(step - 1));
}

std::uint32_t state_after(const Journal& journal, std::uint32_t step) {
  while (step != 0 && !journal.steps[step - 1].keep) step = journal.steps[step - 1].from.value_or(step - 1);
  return step;
}

std::size_t frames_in(const Journal& journal, std::uint32_t step) {
  return step == 0 ? 1 : journal.steps[step - 1].frames();
}

bool is_numbered(const Journal& journal, std::uint32_t step) {
  return step > 0 && journal.steps[step - 1].form() != StepForm::edit;
}

FramePlace place_of(const Journal& journal, std::uint32_t step, std::size_t frame) {
  if (!is_numbered(journal, step)) return {step, std::nullopt, 0};
  return {step, static_cast<std::uint32_t>(frame + 1), static_cast<std::uint32_t>(frames_in(journal, step))};
}

FramePlace last_place_of(const Journal& journal, std::uint32_t step) {
  return place_of(journal, step, frames_in(journal, step) - 1);
}

std::string step_name(const Journal& journal, std::uint32_t step) {
  return step == 0 ? "base" : journal.steps[step - 1].name;
}

}  // namespace relook
