// The values of a frame's layers, tile by tile, from ray trees traced for them; what lights give to frames of
// Integrator::path is weighted from their sums.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "frame/changed_pixels.h"
#include "frame/frame_layers.h"
#include "image/layers/half_light.h"
#include "trace/tree/grow.h"

namespace relook {

using LayerColumns = std::vector<std::vector<float>>;  // [channel][pixels of the tile]

/// A scene made ready for its layers; shared by threads.
struct LayerScene {
  /// All three must outlive it.
  LayerScene(const Scene& scene, const ViewOptions& view, const FrameLayers& layers);

  const ViewOptions& view;
  const FrameLayers& layers;
  std::optional<Scene> first_hits;  // of path: the scene without lights, of whose trees only the first hits are used
  ColorScene rays;
  Tracer tracer{false};
  Tracer::TopLevel level;
  GrowScene grow;
  std::optional<HalfScene> halves;                      // of path, from two samples a pixel on
  std::vector<std::uint32_t> object_ids, material_ids;  // Cryptomatte's, by ObjectId
};

/// Works on one tile after another; one per thread.
class LayerTile {
 public:
  LayerTile(const LayerScene& scene, ProgramTable& programs);
  /// The values of a tile's layers, valid until the next call. `frame`: of the scene; `changed`: which pixels of the
  /// tile have changed, null for none; `sums`: of the tile's light, null under Integrator::whitted; `half`: of the
  /// first half of its samples, empty: they are traced, and left there.
  [[nodiscard]] const LayerColumns& columns(const TileRect& rect, const Frame& frame, const TileMask* changed,
                                            const PackedSums* sums, PackedSums& half);

 private:
  void trace(const TileRect& rect, std::uint32_t first_pixel, std::uint32_t last_pixel);
  void set_first_hit(std::uint32_t pixel, std::uint32_t first_sample);
  void set_mattes(std::uint32_t pixel, std::uint32_t first_sample);
  void set_parts(std::uint32_t pixel, std::uint32_t first_sample);
  void set_beauty(const TileRect& rect, const Frame& frame, const TileMask* changed);
  void settle_sums(std::uint32_t pixels);
  void set_lights(const PackedSums& sums);
  void set_variance(const TileRect& rect, const Frame& frame, PackedSums& half);
  void put(std::size_t column, std::uint32_t pixel, std::initializer_list<float> values);

  const LayerScene& s_;
  PrimaryRays primary_;
  PartShader shader_;
  LayerColumns columns_;
  TreeBlock block_;
  std::vector<SpawnedRay> rays_;
  std::vector<std::uint32_t> roots_, ids_;
  std::optional<HalfLight> half_light_;
  std::vector<float> terms_;
  std::vector<std::vector<Rgba>> colors_;  // [part][sample of the chunk]
};

}  // namespace relook
