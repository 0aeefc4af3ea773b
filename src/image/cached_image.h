// Between a cache and a running replay: what preprocess keeps, and the state and image that are restored from it. What
// a cache alone cannot check, because it takes the compiled scene, is checked here.
#pragma once
#include <memory>

#include "cache/cache.h"
#include "cache/residency/residency.h"
#include "cache/stored_tunnels.h"
#include "frame/image.h"
#include "image/counters.h"
#include "image/render.h"
#include "scene/compile/state.h"

namespace relook {

/// Moves `image` into a cache's content, with tunnels or without.
[[nodiscard]] CacheContent cache_content(const SceneState& state, Image image, std::string scene_hash,
                                         TunnelRecord tunnels = {});

/// By tile, of a cache with tunnels: their surface area relative to the mean, as PieceFacts has it.
[[nodiscard]] std::vector<double> tunnel_areas(const SceneState& state, const CacheContent& content);

/// Can hits belong to a scene? They may name triangles that do not exist.
class HitCheck {
 public:
  HitCheck(const Scene& scene, const PathTable& paths, std::uint32_t shadow_bits);
  [[nodiscard]] bool is_sound(const TileTrees& tile) const;

 private:
  std::vector<std::vector<std::uint64_t>> most_;  // [path][hit] triangles of the object
};

/// Traces the tiles of `losses` again and builds tunnels anew, so that `content` is as it was written, byte for byte.
/// Returns what keeps the scene from being compiled, or that the table lacks paths of the scene.
[[nodiscard]] CacheAnswer make_good(CacheContent& content, const CacheLosses& losses);

/// What a replay starts from.
struct OpenedCache {
  std::unique_ptr<SceneState> state;
  Image image;
  std::string scene_hash;
  CacheLosses losses;                        // made good
  Moves rebuilt;                             // for that
  std::shared_ptr<StoredTunnels> tunnels;    // null: the cache has none
  std::shared_ptr<const Manifest> manifest;  // that all of it has been read by
};
/// Reads a cache and compiles its scene meanwhile. `mends`: losses are made good, and tunnels are not read yet;
/// otherwise losses are faults, and tunnels are checked, too. On a fault `opened` is untouched. `residency`: tiles
/// leave memory for it as they are read; null: all are kept.
[[nodiscard]] CacheAnswer open_cache(const std::filesystem::path& path, bool mends, OpenedCache& opened,
                                     Residency* residency = nullptr);

}  // namespace relook
