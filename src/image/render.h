// The full render: trace ray trees, build their colour trees, evaluate them, tile by tile. Preprocessing is the same
// with the ray paths interned and the ray trees kept.
#pragma once
#include <functional>
#include <memory>
#include <span>

#include "frame/image.h"
#include "image/counters.h"
#include "region/tile_tunnels.h"
#include "region/tunnel_shape.h"
#include "scene/scene.h"
#include "trace/tracer.h"

namespace relook {

/// Called with the share done, 0..1, from any thread, one call at a time.
using Progress = std::function<void(double)>;

struct RenderStats {
  Counters counters;                             // ray_updates: rays traced; shadow_updates: shadow segments traced
  double build_seconds = 0, render_seconds = 0;  // acceleration structures; everything else
};

/// The frame of `scene` as it is now. `monitor`: of its acceleration structures.
[[nodiscard]] Frame render(const Scene& scene, const ViewOptions& view, RenderStats& stats,
                           const Progress& progress = {}, const MemoryMonitor& monitor = {});

/// The same with its sums of light, of the path integrator: for layers. Paths and trees are not kept.
[[nodiscard]] Image render_with_sums(const Scene& scene, const ViewOptions& view, RenderStats& stats,
                                     const Progress& progress = {}, const MemoryMonitor& monitor = {});

/// Tunnels that are built while an image's ray trees are traced.
struct TunnelRecord {
  TunnelShape shape{0, 2, std::nullopt};
  std::vector<ObjectId> atoms;        // see atoms_of(); empty without atoms
  std::vector<Sections> around;       // [tiles] around all tunnels of each; empty: the shape allows none
  std::vector<TileTunnels> of_tiles;  // [tiles]
};

/// The same frame, bit for bit, with paths, ray trees and sample colours kept. Ids do not depend on the thread count.
/// `tunnels`: null, or what to build beside.
[[nodiscard]] Image preprocess(const Scene& scene, const ViewOptions& view, RenderStats& stats,
                               const Progress& progress = {}, TunnelRecord* tunnels = nullptr);
/// Traces some tiles of `image` (increasing) again: their paths, ray trees, sample colours and pixels. With the scene
/// that the image was made from it is afterwards as preprocess() made it, provided that its path table is that image's,
/// or empty and `tiles` are all.
void rebuild_tiles(const Scene& scene, Image& image, std::span<const std::size_t> tiles, RenderStats& stats,
                   const Progress& progress = {});

}  // namespace relook
