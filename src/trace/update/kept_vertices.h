// Hits and rays as lights read them, kept from one step to the next: a light that moves or is swapped is sampled at
// vertices and met by rays without ray trees, points on surfaces or textures, bit for bit. Made from nodes of ray trees
// under Integrator::path, restored to as much of a node as samples of lights and met lights need. Kept by tile:
// color/path/tile_vertices.h.
#pragma once
#include <array>
#include <cstdint>

#include "trace/tree/tree_block.h"

namespace relook {

/// The lobes of a hit, as far as their densities follow from a normal, a view and buckets.
class KeptLobes {
 public:
  KeptLobes() = default;
  /// `view`: unit, of the world, to where the ray came from.
  KeptLobes(const VertexLobes& lobes, const Direction& view);
  /// Has restored() the densities of these, bit for bit? Others are kept as they are.
  [[nodiscard]] bool holds(const VertexLobes& lobes) const;
  [[nodiscard]] VertexLobes restored() const;

 private:
  [[nodiscard]] bool has_coat() const { return shares_[2] > 0; }

  Normal normal_{0, 0, 1}, coat_normal_{0, 0, 1};
  Direction view_{0, 0, 1};
  std::array<float, 4> shares_{};  // of diffuse, specular, coat, transmission
  AlphaBucket specular_{-1}, coat_{-1}, transmission_{-1};
  bool has_sheen_ = false;
};

/// A hit that gathers light.
struct LitVertex {
  /// `node`: completed, with its lobes in the block if it has some.
  LitVertex(const TreeBlock& block, const RayNode& node);
  /// Fills what samples of lights and segments to them read of a node.
  void restore(RayNode& node) const;
  [[nodiscard]] bool has_lobes() const { return (flags & kHasLobes) != 0; }

  static constexpr std::uint16_t kStraightMask = 0x1F, kHasBack = 0x20, kIsWide = 0x40, kIsShut = 0x80,
                                 kHasLamps = 0x100, kIsBehind = 0x200, kHasLobes = 0x400;
  Point position;
  Normal geometric, shading;
  Direction lift;
  float offset;
  float footprint;
  SampleKey key;
  std::array<std::uint32_t, 2> history;  // low, high half
  ObjectId object;
  std::uint16_t flags;                  // the lowest five bits: straight rays so far
  std::uint16_t pixel = 0;              // of the tile
  std::uint32_t hit = 0;                // its number among the hits of the tile's paths, in their order
  std::uint32_t other_lobes = kNoNode;  // where KeptLobes does not hold them: place among those kept as they are
  float scale = 1;                      // of what it scatters, for its coverage
  Color weight;                         // of what comes from it to the eye
  KeptLobes lobes;
};

/// A ray that may meet lights with a size, or leaves the scene.
struct MetRay {
  explicit MetRay(const RayNode& node);
  void restore(RayNode& node) const;

  static constexpr std::uint8_t kIsEye = 1, kIsShut = 2, kIsAlone = 4, kIsFirst = 8;
  Point origin;
  Direction direction;
  float first, last;  // metres: lights between are met
  float density;
  ObjectId from;
  Color weight;             // of what comes along it to the eye
  std::uint16_t pixel = 0;  // of the tile
  std::uint8_t flags;
};

}  // namespace relook
