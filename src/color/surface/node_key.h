// What the colour expression of a node depends on beside its material's values: how the ray met it, the visible lights,
// its branches, and which part of its colour is asked for.
#pragma once
#include <compare>
#include <cstdint>
#include <span>
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
/// between; `asked`: each node says for itself whether the light reaches it.
struct VisibleLight {
  LightId light;
  std::uint32_t order = 0;
  bool filtered = false, asked = false;
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

/// With more lights than this in a scene, hardly two nodes see the same ones: programs then take all lights, asked, so
/// that there are as few programs as ever. The bits are those of programs for the lights that reach a node.
inline constexpr std::size_t kMostTellingLights = 32;
/// The lights of a scene's order as such a program takes them.
[[nodiscard]] std::vector<VisibleLight> asked_lights(std::span<const LightId> order);

}  // namespace relook
