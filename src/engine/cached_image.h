// Between a cache and a running replay: what preprocess keeps, and the state and image that are restored from it. What
// a cache alone cannot check, because it takes the compiled scene, is checked here.
#pragma once
#include <memory>

#include "cache/cache.h"
#include "engine/image.h"
#include "scene/state.h"

namespace relook {

/// Moves `image` into a cache's content.
[[nodiscard]] CacheContent cache_content(const SceneState& state, Image image, std::string scene_hash);

/// The first reason why the image's paths and hits cannot belong to `scene`, "" if there is none: triangles that do not
/// exist.
[[nodiscard]] std::string broken_hits(const Scene& scene, const Image& image);

/// Traces the tiles of `losses` again, so that `content` is as it was written, byte for byte. Returns what keeps the
/// scene from being compiled.
[[nodiscard]] CacheAnswer make_good(CacheContent& content, const CacheLosses& losses);

/// What a replay starts from.
struct OpenedCache {
  std::unique_ptr<SceneState> state;
  Image image;
  std::string scene_hash;
  CacheLosses losses;  // made good
};
/// Reads a cache and compiles its scene meanwhile. `mends`: losses are made good, otherwise they are faults. On a fault
/// `opened` is untouched.
[[nodiscard]] CacheAnswer open_cache(const std::filesystem::path& path, bool mends, OpenedCache& opened);

}  // namespace relook
