// The light of one tile: the colour of every sample, or, under the path integrator, sums of light by pixel; and how
// blocks of ray trees are shaded into it, whichever it is. Used by render (all samples of a tile) and what follows it.
#pragma once
#include <optional>
#include <vector>

#include "color/path/path_shader.h"
#include "color/shade.h"
#include "frame/image.h"
#include "scene/light_sums.h"
#include "trace/tree/grow.h"

namespace relook {

struct TileLight {
  std::vector<Rgba> colors;  // [samples] under Integrator::whitted
  TileSums sums;             // under Integrator::path
};

/// What growing needs, as the view has it.
[[nodiscard]] GrowScene grow_scene(const RayScene& scene, const Tracer::TopLevel* level, const ViewOptions& view,
                                   std::uint32_t shadow_bits, const ObjectLevels* objects = nullptr);

/// The colours of a scene's sums, in their order.
[[nodiscard]] std::vector<LightColor> colors_of(std::span<const LightSum> sums);

/// The programs of a scene and the list of its sums; shared by threads.
class TilePrograms {
 public:
  /// `scene` outlives it.
  explicit TilePrograms(const ColorScene& scene);

  [[nodiscard]] const ColorScene& scene() const { return scene_; }
  [[nodiscard]] bool is_path() const { return scene_.scene().integrator == Integrator::path; }
  [[nodiscard]] const SumPlaces& places() const { return places_; }
  [[nodiscard]] ProgramTable& whitted() const { return whitted_; }
  [[nodiscard]] PathPrograms& path() const { return path_; }
  /// A pixel of a tile, by its number.
  [[nodiscard]] Rgba pixel(const TileLight& light, std::size_t pixel, std::uint32_t samples) const;
  /// All of them.
  void set_pixels(const TileRect& rect, const TileLight& light, std::uint32_t samples, Frame& frame) const;

 private:
  const ColorScene& scene_;
  std::vector<LightSum> sums_;
  SumPlaces places_;
  std::vector<LightColor> colors_;
  mutable ProgramTable whitted_;  // both are thread-safe
  mutable PathPrograms path_;
};

/// Shades blocks of trees; one per thread.
class TileShading {
 public:
  /// `programs` outlives it. `samples`: per pixel.
  TileShading(const TilePrograms& programs, std::uint32_t samples);
  /// Makes room for the samples of a tile.
  void begin(const TileRect& rect, TileLight& light) const;
  /// `roots`: those of the samples from `first` on, all trees of the block.
  void add(const TreeBlock& block, std::span<const std::uint32_t> roots, std::uint32_t first, TileLight& light);

 private:
  const TilePrograms& programs_;
  std::uint32_t samples_;
  std::optional<Shader> shader_;
  std::optional<PathShader> path_shader_;
};

}  // namespace relook
