// A journal replayed event by event: the one place that leads an image from frame to frame. Edits whose frames nobody
// asks for wait and reach the image together, as one change. What a frame changed is said from where its step starts:
// an option is compared with what it is an option to, whatever came between.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "edit/journal_walk.h"
#include "edit/scene_history.h"
#include "replay/replay.h"

namespace relook {

class JournalReplay {
 public:
  /// `replayer`: in the state before any step. Both outlive this.
  JournalReplay(const Journal& journal, Replayer& replayer);

  /// Does what leads to an event's frame, or ends its drag. Events come in the order of the walk. The result tells what
  /// has changed since the image was last brought up to date here. Throws InputError with everything as before.
  StepResult follow(const JournalEvent& event);
  /// Passes an event whose frame is not wanted: its edit is made with the next ones, or at once while a selection is
  /// being dragged.
  void skip(const JournalEvent& event);
  /// Makes the edits that wait. Called by follow(), too; alone, so that they are timed by themselves.
  void catch_up();
  [[nodiscard]] bool is_up_to_date() const { return waiting_.empty(); }

  /// The pixels that the frame of the last event given to follow() has other than the one its step starts from; of
  /// later frames of a drag or wedge: than the one before.
  [[nodiscard]] const ChangedPixels& changed_in_step() const { return changed_in_step_; }

 private:
  [[nodiscard]] StepResult drag(const JournalEvent& event);
  void end_event(const JournalEvent& event);

  const Journal& journal_;
  Replayer& replayer_;
  SceneHistory history_;
  std::vector<JournalEvent> waiting_;
  std::map<std::uint32_t, std::uint32_t> last_uses_;  // of states that steps go back to: by the last of these
  std::map<std::uint32_t, Frame> starts_;             // frames of these states, as long as they are needed
  ChangedPixels changed_in_step_;
  bool is_dragging_ = false;
};

}  // namespace relook
