// A journal as a series of events, and the only place that says what follows what: which frames a step has and how they
// are numbered, when what is dragged is let go, what of a wedge stays in the scene, where a step starts. Replay, plan,
// blame, inspect, render, the rehearsal of a journal and the hashes of its edits all follow it. Events are made one at
// a time, and an edit when it is asked for: a wedge of a million values takes the memory of its text.
//
// An edit is made of the scene as the event before left it. A step that starts elsewhere, since it says so (`from`) or
// since the one before it is put back (`keep`), says where in its first frame: back_to (edit/scene_history.h goes
// there). All who follow a walk switch over the kinds without a default, as follow_edits() does: the compiler names
// those that lack one. A step with other frames is one more StepForm, in JournalStep::frames() and edit_of().
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "edit/frame_place.h"
#include "edit/journal.h"

namespace relook {

enum class EventKind : std::uint8_t {
  base,       // the frame before any edit
  edit,       // an edit is made, a step's only one or a value of a wedge; then there is a frame
  drag,       // an edit of what is being dragged is made; then there is a frame
  release,    // what was dragged is let go where the last frame put it
  wedge_end,  // a wedge is over: its last value stays in the scene, unless the next step goes back
};

struct JournalEvent {
  EventKind kind = EventKind::base;
  FramePlace place;                   // release, wedge_end: of the step's last frame
  std::size_t frame = 0;              // the same within the step, from 0
  const JournalStep* step = nullptr;  // base: none
  std::optional<std::uint32_t> back_to;  // of a first frame: its step starts in the state after this one, 0: base

  /// Whether there is a frame; the other events end a drag or wedge as a whole.
  [[nodiscard]] bool has_frame() const {
    return kind == EventKind::base || kind == EventKind::edit || kind == EventKind::drag;
  }
  [[nodiscard]] bool is_first_frame() const { return has_frame() && frame == 0; }
  /// Requires: edit or drag.
  [[nodiscard]] bool is_last_frame() const { return frame + 1 == step->frames(); }
  /// Requires: edit or drag.
  [[nodiscard]] Edit edit() const { return step->edit_of(frame); }
};

/// The events of the steps asked for, in order. Refers to the journal, which must outlive it.
class JournalWalk {
 public:
  class Iterator {
   public:
    Iterator(const Journal& journal, std::uint32_t step) : journal_(&journal), step_(step) {}
    [[nodiscard]] JournalEvent operator*() const;
    Iterator& operator++();
    [[nodiscard]] bool operator==(const Iterator&) const = default;

   private:
    const Journal* journal_;
    std::uint32_t step_;
    std::size_t event_ = 0;  // of the step: its frames, then the end of a drag or wedge
  };

  /// All steps, without the frame before any edit.
  explicit JournalWalk(const Journal& journal)
      : JournalWalk(journal, 1, static_cast<std::uint32_t>(journal.steps.size())) {}
  /// From step `first`, 0 for the frame before any edit, to step `last`; nothing when that is before it.
  JournalWalk(const Journal& journal, std::uint32_t first, std::uint32_t last)
      : journal_(journal), first_(first), end_(last < first ? first : last + 1) {}
  [[nodiscard]] Iterator begin() const { return {journal_, first_}; }
  [[nodiscard]] Iterator end() const { return {journal_, end_}; }

 private:
  const Journal& journal_;
  std::uint32_t first_, end_;
};

/// Calls `visit(event)` for each edit: for callers to whom a frame of a drag is an edit like any other.
template <class Visit>
void follow_edits(const JournalWalk& walk, const Visit& visit) {
  for (const JournalEvent& event : walk) {
    switch (event.kind) {
      case EventKind::edit:
      case EventKind::drag:
        visit(event);
        break;
      case EventKind::base:
      case EventKind::release:    // what was dragged stays where it is
      case EventKind::wedge_end:
        break;
    }
  }
}

// States. The one after a step is that of its last frame, or, if it is put back, the one before it.
/// The step whose last frame a step starts from; 0: the scene before any edit.
[[nodiscard]] std::uint32_t state_before(const Journal& journal, std::uint32_t step);
[[nodiscard]] std::uint32_t state_after(const Journal& journal, std::uint32_t step);

// Single frames. `step`: of the journal, from 1; 0: the frame before any edit. `frame`: within it, from 0.
[[nodiscard]] std::size_t frames_in(const Journal& journal, std::uint32_t step);
/// Whether a step is a drag or a wedge: its frames have numbers, and it has an end beside them.
[[nodiscard]] bool is_numbered(const Journal& journal, std::uint32_t step);
[[nodiscard]] FramePlace place_of(const Journal& journal, std::uint32_t step, std::size_t frame);
[[nodiscard]] FramePlace last_place_of(const Journal& journal, std::uint32_t step);
/// "base" for 0.
[[nodiscard]] std::string step_name(const Journal& journal, std::uint32_t step);

}  // namespace relook
