// What the colour expression of a node depends on beside its material's values: how the ray met it, the visible lights,
// its branches, and which part of its colour is asked for.
#pragma once
#include <compare>
#include <cstdint>
#include <vector>

#include "base/id.h"
#include "trace/tree/branch.h"

namespace relook {

enum class NodeKind : std::uint8_t { surface, filter, environment };

/// What a program yields: the colour, or what a layer of a frame shows of a surface (zero for the environment): its
/// base colour and coverage, or its normal-mapped normal, in the world and on the ray's side.
enum class Aspect : std::uint8_t { color, albedo, normal };

/// Where light comes from, beside lamps: a bit each. The colour of an unlit surface is emission.
enum Source : std::uint8_t { kAmbientSource = 1, kEnvironmentSource = 2, kEmissionSource = 4, kAllSources = 7 };

/// A light that reaches a node. `order`: its place in the light order; `filtered`: transparent surfaces may stand in
/// between.
struct VisibleLight {
  LightId light;
  std::uint32_t order = 0;
  bool filtered = false;
  auto operator<=>(const VisibleLight&) const = default;
};

/// Nodes with equal keys share a program and its parameters.
struct NodeKey {
  NodeKind kind = NodeKind::environment;
  MaterialId material;  // none for the environment
  bool inside = false;
  bool vertex_colors = false;
  bool interface_only = false;  // the inner side of a volume
  BranchSet children;
  Aspect aspect = Aspect::color;
  std::uint8_t sources = kAllSources;  // that count
  bool sums = false;  // the program adds whichever lamps reach a node: it is one for all `lights`
  std::vector<VisibleLight> lights;
  auto operator<=>(const NodeKey&) const = default;
};

/// A part of the colours of nodes: that of some sources and lamps, through some branches.
struct ColorPart {
  Aspect aspect = Aspect::color;
  std::uint8_t sources = kAllSources;
  BranchSet branches = BranchSet::all();
  bool all_lamps = true;
  LightId lamp{};  // unless all: the only one, or none
};
[[nodiscard]] NodeKey restricted(NodeKey key, const ColorPart& part);

/// With more lights than this in a scene, programs by visible lights would be as many as nodes: programs then add
/// whichever lamps reach a node. The bits are the same.
inline constexpr std::size_t kMostTellingLights = 6;

}  // namespace relook
