// One pixel through a series of edits: its colour after each, traced as a full render traces it, and through which
// objects and lights an edit has changed it. Called by `relook blame`.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "edit/scene_history.h"
#include "frame/image.h"
#include "scene/compile/state.h"

namespace relook {

/// What an edit did to a pixel.
struct PixelStep {
  Classification classification;
  Rgba before, after;
  bool is_changed = false;  // any bit of its colour
  /// One a changed thing that the pixel depends on, before or after: "material Glass: RightSphere",
  /// "node Cube: shadow from light Lamp on Floor".
  std::vector<std::string> causes;
};

class PixelHistory {
 public:
  /// Requires: the pixel is one of the camera's.
  PixelHistory(SceneState state, const ViewOptions& view, std::uint32_t x, std::uint32_t y);
  ~PixelHistory();
  PixelHistory(const PixelHistory&) = delete;
  PixelHistory& operator=(const PixelHistory&) = delete;

  [[nodiscard]] Rgba color() const;
  /// The ray paths of the pixel's samples in names, a node a line.
  [[nodiscard]] const std::vector<std::string>& paths() const;

  /// Applies an edit, such as those of an event of a journal. Throws what it throws, with everything as before.
  PixelStep step(const SceneEdit& edit);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relook
