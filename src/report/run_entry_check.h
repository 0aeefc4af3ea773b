// What an entry of a run says is believed only as far as it can be: progress.jsonl and report.json may have been
// changed by anybody. First its form: every member that step_json() writes, no other, every number in its range, no
// name of a file but the frame's own. Then what the journal and the cache already say of the frame. A seal or hash
// tells damage and careless changes, not a forger, who can make it anew; what a forger may still claim is in
// cli/README.md.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "base/json.h"
#include "frame/frame_file.h"

namespace relook {

/// Throws InputError unless an entry has the form that step_json() gives it.
void check_entry(const Json& entry);

/// What is known of a frame without its entry.
struct KnownFrame {
  std::string edits, source, frame, preview;
  bool is_numbered = false, is_drag = false;  // numbered: of a drag, otherwise of a wedge
  bool is_base = false;                       // the frame before any step
  bool is_whole_step = false;  // a drag or wedge, which has no frame of its own
  std::uint64_t pixels = 0, samples = 0;
};
/// Whether an entry, which check_entry() has passed, can be of this frame.
[[nodiscard]] bool agrees(const Json& entry, const KnownFrame& known);

/// The text of an object with a last member that seals it: `"seal"`, the XXH3-128 of the text without it.
[[nodiscard]] std::string sealed(std::string text);
/// Whether a text is as sealed() has made it.
[[nodiscard]] bool has_sound_seal(std::string_view text);

}  // namespace relook
