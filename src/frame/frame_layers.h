// What layers a frame with --aovs has, as a table that follows from the scene: names of channels, header attributes,
// and the parts of the colour that make up each sum. LAYERS.md lists them.
//
// A sum is a list of layers whose float32 values, added from first to last, are the frame's R, G and B, bit for bit.
// Under Integrator::whitted it is a list of parts, and its last layer, the rest, is there for that: what rounding
// leaves between the others and the frame in the file. A frame of Integrator::path is such a sum: a layer a light.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "color/part_shader.h"
#include "frame/cryptomatte.h"
#include "frame/light_sums.h"

namespace relook {

/// Columns of values that every frame has, by place among the channels.
enum LayerColumn : std::size_t {
  kBeautyColumn = 0,     // R, G, B, A
  kAlbedoColumn = 4,     // R, G, B: mean of the samples
  kNormalColumn = 7,     // X, Y, Z; this and the next three: of the sample whose hit is nearest
  kPositionColumn = 10,  // X, Y, Z: world, metres
  kDepthColumn = 13,     // Z: metres along the camera's forward axis
  kUvColumn = 14,        // U, V: TEXCOORD_0
  kChangedColumn = 16,   // A: 1 where the step changed the frame
  kFixedColumns = 17
};
/// Depth where nothing is met.
inline constexpr float kFarDepth = 1e10F;

/// Parts of the frame's colour, each three channels, and the rest after them.
struct LayerSum {
  std::size_t first_part = 0, parts = 0;  // in FrameLayers::parts
  std::size_t first_column = 0;
};

/// Throws UsageError if the scene has more lights than a frame can have layers of.
void require_layers(const Scene& scene);

struct FrameLayers {
  /// Throws as require_layers().
  FrameLayers(const Scene& scene, std::uint32_t samples, PixelFormat format);

  std::vector<ExrChannel> channels;  // by column
  ExrAttributes attributes;
  std::vector<LayerPart> parts;  // the first two: albedo and normal
  std::vector<LayerSum> sums;              // of whitted
  std::vector<LightColor> light_colors;    // of path: by light_sums(), whose layers have the columns
  std::size_t light_column = 0;            // from this one on, three a light
  std::optional<std::size_t> variance_column;  // of path, from two samples a pixel on: three
  Cryptomatte objects, materials;
  std::size_t object_column = 0, material_column = 0;

 private:
  void add_sum(const char* attribute, const std::vector<std::pair<std::string, LayerPart>>& layers,
               const std::string& rest);
  void add_lights(const Scene& scene, std::uint32_t samples);
  void add_color(const std::string& layer);
};

/// The name by which Cryptomatte knows a material.
[[nodiscard]] std::string matte_name(const Material& material);

}  // namespace relook
