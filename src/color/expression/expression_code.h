// Colour expressions in the form in which they are built and taken apart: instructions in order, operands before their
// users. Leaves are constants, parameters (pointers into the scene) and inputs (per-sample constants); inner nodes are
// n-ary functions (paper 2.1).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace relook {

enum class Op : std::uint8_t {
  // leaves
  constant,        // payload: bits of a float
  material_field,  // payload: Field | component << 8
  slot_color,      // payload: Slot | component << 8: color1 (0..2) and color2 (3..5) of a procedural texture
  light_field,     // payload: LightField | light index << 8
  ambient,         // payload: component
  environment,     // payload: component of color * intensity
  input,           // payload: Input | detail << 8
  column,          // payload: which stored column: a subexpression that has been evaluated before (paper 3.3)
  // functions of one, two, three values
  sqrt,
  exp2,
  log2,
  cos_turns,  // cos(2 pi a)
  add,
  subtract,
  multiply,
  divide,
  min,
  max,
  if_positive,        // a > 0 ? b : c
  multiply_add,       // a b + c, each operation rounded: in kernels only
  sheen_albedo,       // (cosine, roughness)
  procedural_weight,  // payload: slot; (x, y, z, area ratio) to the share of color2
  // lookups: several results in consecutive registers (see `channel`)
  coordinates,      // payload: slot; per-sample constants: x, y, z, area ratio
  tangent_frame,    // payload: slot; per-sample constants: tangent, bitangent
  texture,          // payload: slot; (x, y, z, area ratio, footprint) to RGBA
  environment_map,  // direction (x, y, z) to RGBA
  channel,          // payload: which result of the lookup given as operand; result 0 is the lookup itself
};

/// Per-sample constants of a node, gathered from its hit.
enum class Input : std::uint8_t {
  position,
  normal,
  geometric,
  view,          // these four: detail is the axis
  vertex_color,  // detail: channel
  footprint,
  length_inside,
  child,         // detail: channel | branch << 4
  child_length,  // detail: branch
  tint,          // detail: channel | index in the light order << 4
  reached,       // does that light reach the node, 1 or 0; detail: index in the light order << 4
};
/// Parts of the payload of an `input` instruction.
[[nodiscard]] constexpr Input input_of(std::uint32_t payload) { return static_cast<Input>(payload & 0xFFU); }
[[nodiscard]] constexpr std::uint32_t input_axis(std::uint32_t payload) { return payload >> 8 & 15U; }
[[nodiscard]] constexpr std::uint32_t input_which(std::uint32_t payload) { return payload >> 12; }

/// A value of an expression: an index into its code.
using Value = std::uint32_t;

struct Instruction {
  Op op = Op::constant;
  std::uint32_t payload = 0;
  std::array<Value, 5> operands{};
  bool operator==(const Instruction&) const = default;
};
using Code = std::vector<Instruction>;

[[nodiscard]] unsigned operand_count(Op op);
/// Number of registers that an instruction writes.
[[nodiscard]] unsigned result_count(Op op);
[[nodiscard]] inline bool is_lookup(Op op) { return result_count(op) > 1; }
/// Leaves with one value for a whole batch.
[[nodiscard]] inline bool is_parameter(Op op) { return op <= Op::environment; }
/// Plain arithmetic on lanes.
[[nodiscard]] inline bool is_arithmetic(Op op) { return op >= Op::sqrt && op <= Op::multiply_add; }
/// Does the value differ from sample to sample, given that of its operands?
[[nodiscard]] std::vector<bool> find_uniform(const Code& code);

/// Straight-line code over registers, uniform part first.
struct Kernel {
  struct Step {
    Op op;
    std::uint32_t payload;
    std::uint32_t out;
    std::array<std::uint32_t, 5> in;
  };
  std::vector<Step> uniform;  // run once per batch: constants, parameters and what follows from them alone
  std::vector<Step> varying;  // run over all lanes
  std::uint32_t registers = 0;
  std::vector<std::uint32_t> outputs;  // registers of the values asked for
};

/// Drops what `outputs` do not need, splits uniform from varying code, assigns registers.
[[nodiscard]] Kernel make_kernel(const Code& code, const std::vector<Value>& outputs);

}  // namespace relook
