// Journals made from something else: the variants and animations of a scene, values for one parameter, and
// (draft_diff.h) two exports of a scene. What they cannot say is named in warnings. Called by the `journal` verb, which
// checks a draft as it would any journal.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "scene/compile/state.h"
#include "scene/gltf/animation.h"
#include "scene/look/look.h"

namespace relook {

struct JournalDraft {
  Json steps = Json::array();
  std::vector<std::string> warnings;
};

/// The journal's text: a line a step, an entry of a drag a line; `generated` is the hash of what follows it.
[[nodiscard]] std::string journal_text(const JournalDraft& draft);
/// Whether a journal is as journal_text() made it: not written or changed by hand since.
[[nodiscard]] bool is_generated_journal(std::string_view text);

/// A number as short as it can be written so that it is read as the same float.
[[nodiscard]] double short_real(float value);

/// KHR_materials_variants: a step for each, that sets the material of every primitive that any variant changes; a
/// primitive that a variant does not map gets its own. Throws InputError when there are none.
[[nodiscard]] JournalDraft draft_variants(const LookDocument& document);

/// One parameter's values, each JSON, a word (a name) or A..B:N for N values from A to B. Neighbouring values are one
/// step, a range is a step. Throws UsageError for what is none of these.
[[nodiscard]] JournalDraft draft_wedge(const std::string& pointer, const std::vector<std::string>& values);

/// When an animation is sampled. Without `from` and `to`: from its first to its last keyframe.
struct SampleTimes {
  double frames_per_second = 24;
  std::optional<double> from, to;  // seconds
};
/// A frame at each sample time. Nodes that move are one drag; if anything else changes too, an edit a frame. A frame
/// says what differs from the one before. Channels that no journal can express are named in warnings; throws
/// InputError when all are so, and when there are too many frames.
[[nodiscard]] JournalDraft draft_animation(const SceneState& state, const Animation& animation,
                                           const SampleTimes& times);

}  // namespace relook
