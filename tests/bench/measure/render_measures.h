// The full render, its preprocessing, and what they are measured against: the bare loop over the same rays.
#pragma once
#include "setup.h"

namespace relook {

struct RenderTimes {
  double full_seconds = 0, preprocess_seconds = 0;
  double ray_nanoseconds = 0;  // of one thread, that a ray or shadow segment takes in the full render
};

/// Prints the full render's figures. `image`: gets what preprocessing gives.
[[nodiscard]] RenderTimes print_render(const BenchOptions& options, const SceneState& state, Image& image);

/// Prints what a texture lookup costs, if the scene has an image texture.
void print_texture_price(const SceneState& state, const RenderTimes& times);

}  // namespace relook
