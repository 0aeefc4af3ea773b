// What all frames of a run have in common, so that parts of it can be made by several commands: the scene, the view and
// the arithmetic of its cache, and how its files are written. Nothing here depends on structures, memory or threads,
// which show in no frame. `replay` refuses to go on with a run of another source (cli/run/run_plan.h).
#pragma once
#include <optional>
#include <string>

#include "base/json.h"

namespace relook {

struct FrameStyle {
  bool is_float = false, has_layers = false;
  std::string view;  // DisplayView::id() of the previews; "": sRGB
};

/// The source of runs from a cache. `manifest`: as read_manifest() gives it.
[[nodiscard]] Json run_source(const Json& manifest, const FrameStyle& style);
/// What each entry of a run says of its source: XXH3-128.
[[nodiscard]] std::string hash_of_source(const Json& source);
/// How a run that is there differs from one here: "frames of 960x540, not 480x270"; none when both have the same
/// source.
[[nodiscard]] std::optional<std::string> difference_of_sources(const Json& there, const Json& here);

}  // namespace relook
