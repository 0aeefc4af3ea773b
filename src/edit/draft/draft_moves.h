// Journals that turn nodes on a turntable and that aim lights: what their quaternions are is worked out here.
#pragma once
#include <optional>
#include <string>

#include "edit/draft/journal_draft.h"

namespace relook {

struct TurntableOptions {
  std::uint32_t frames = 24;
  std::string axis = "y";        // x, y, z: of the world
  double degrees = 360;          // the last frame is turned by all of it; counter-clockwise from the axis' tip
  std::string about = "bounds";  // the middle of what turns; "origin": the scene's
  bool environment = false;      // a step that turns the environment alone
};
/// Steps of `frames` frames each: the nodes turned, as a drag, and, if asked for, the environment turned, as a wedge.
/// `node`: "all", the topmost nodes that show something and do not hold a camera, together; "": none. Throws InputError
/// for what cannot be turned.
[[nodiscard]] JournalDraft draft_turntable(const LookDocument& document, const std::string& node,
                                           const TurntableOptions& options);

struct AimOptions {
  // Degrees and metres of where the subject is put, as seen from the target: azimuth 0 is the camera's side and 90 its
  // right hand, elevation 90 straight above. What is not given stays.
  std::optional<double> azimuth, elevation, distance;
  std::uint32_t orbit = 0;  // frames of a drag once round the target; 0: one edit
};
/// A step after which a light (by its name or its node's) shines at a target, or another node's +z, its front in glTF,
/// looks at it. `target`: a node, the middle of what it shows, or "x,y,z" in metres. Throws InputError, UsageError.
[[nodiscard]] JournalDraft draft_aim(const LookDocument& document, const Camera& camera, const std::string& subject,
                                     const std::string& target, const AimOptions& options);

/// A direction (unit) from a target, by azimuth and elevation as above.
[[nodiscard]] WidePoint direction_from(const Camera& camera, const WidePoint& target, double azimuth, double elevation);

}  // namespace relook
