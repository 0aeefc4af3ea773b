// Caches with tunnels for tests.
#pragma once
#include "image/cached_image.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {

/// What preprocess would store of a scene with such tunnels.
[[nodiscard]] CacheContent content_with_tunnels(const SceneState& state, const ViewOptions& view,
                                                const RegionOptions& regions);

/// A replay of the scene of a cache that is written to `path` first, as a program would open it.
[[nodiscard]] Replayer replayer_of_cache(const SceneState& state, const ViewOptions& view, const RegionOptions& regions,
                                         const std::filesystem::path& path, const ResidencyOptions& residency = {});

/// Opens the cache at `path` for a replay.
[[nodiscard]] OpenedCache opened_cache(const std::filesystem::path& path);

}  // namespace relook
