// Programs in pieces, for scenes of many lights: what no lamp changes is evaluated once a node, what a lamp adds is
// evaluated for the nodes that it reaches, from columns of the node. There are as many programs as without lamps,
// whichever of them reach a node. Run by NodeSums (node_sums.h).
#pragma once
#include <array>
#include <optional>
#include <span>

#include "color/expression/expression_code.h"

namespace relook {

/// What a lamp adds to a sum has an expression for each kind of light, filtered or not.
inline constexpr std::size_t kLightTerms = 2 * kLightKinds;
[[nodiscard]] constexpr std::size_t light_term(LightKind kind, bool filtered) {
  return 2 * static_cast<std::size_t>(kind) + (filtered ? 1 : 0);
}

[[nodiscard]] constexpr bool is_filtered(std::size_t light_term) { return light_term % 2 != 0; }

/// A sum to which the lamps that reach a node add their light, one after the other in the light order. The sum with all
/// of it is Input::sum, behind all these expressions in the code.
struct LampSum {
  using Rgb = std::array<Value, 3>;
  Rgb before{};  // the sum without any lamp
  std::array<std::optional<Rgb>, kLightTerms> terms;  // what a lamp adds, for the kinds of lights that the scene has
};

/// By value: does it depend on the lamp at hand, and not by way of a sum?
[[nodiscard]] std::vector<bool> find_light_values(const Code& code);

/// The kernels of a program with sums.
struct Pieces {
  std::vector<Value> columns;  // of a node: what no lamp changes
  Kernel constants;            // outputs: the columns
  std::vector<Kernel> stages;  // read columns and sums; by sum: R, G, B before it; the last: R, G, B, A
  std::vector<std::array<Kernel, kLightTerms>> terms;  // by sum: R, G, B; read columns and the lamp at hand
};
[[nodiscard]] Pieces make_pieces(const Code& code, std::span<const LampSum> sums, const std::array<Value, 4>& result);

}  // namespace relook
