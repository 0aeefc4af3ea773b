// Colour expressions in the form in which they are built and taken apart: instructions in order, operands before their
// users. Leaves are constants, parameters (pointers into the scene) and inputs (per-sample constants); inner nodes are
// n-ary functions (paper 2.1).
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "color/expression/field.h"

namespace relook {

enum class Op : std::uint8_t {
  // leaves
  constant,        // payload: its value
  material_field,  // payload: Field, component
  slot_color,      // payload: Slot, component: color1 (0..2) and color2 (3..5) of a procedural texture
  light_field,     // payload: LightField, light
  ambient,         // payload: number of the component
  environment,     // payload: number of the component of color * intensity
  input,           // payload: Input, axis, which
  column,          // payload: number of a stored column: a subexpression that has been evaluated before (paper 3.3)
  // functions of one to four values
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
  channel,          // payload: number of a result of the lookup given as operand; result 0 is the lookup itself
};

/// Per-sample constants of a node, gathered from its hit.
enum class Input : std::uint8_t {
  position,
  normal,
  geometric,
  view,          // these four by axis
  vertex_color,  // by axis: channel
  footprint,
  length_inside,
  child,         // by axis: channel; which: branch
  child_length,  // which: branch
  tint,          // by axis: channel; which: index in the light order
  sum,           // by axis: channel; which: number of a sum of lamps' light (LampSum in program.h)
  // of the path integrator
  child_direction,  // by axis; which: branch
  child_share,      // 1 / (density of the direction * share of its lobe), steradians; which: branch
  alpha_floor,      // least alpha of reflecting lobes
  cosine,           // of a filter: of the shadow segment with the geometric normal
  light_direction,  // by axis: unit, towards the sample of the light at hand
  light_weight,     // by axis: of diffuse, specular, coat and transmitted lobe
  light_radiance,   // by axis: channel; of that sample at unit colour and intensity
};

/// Is it of a sample of a light, not of the hit alone?
[[nodiscard]] constexpr bool is_of_light_sample(Input input) { return input >= Input::light_direction; }

/// In the expression of what any one lamp adds: that lamp, and its place in the light order.
inline constexpr LightId kLightAtHand{(1U << 24) - 1U};
inline constexpr std::uint32_t kPlaceAtHand = (1U << 20) - 1U;

/// What an instruction has beside its operands. Op says which of these it is.
class Payload {
 public:
  constexpr Payload() = default;
  [[nodiscard]] static constexpr Payload constant(float value) { return Payload(std::bit_cast<std::uint32_t>(value)); }
  [[nodiscard]] static constexpr Payload number(std::uint32_t number) { return Payload(number); }
  [[nodiscard]] static constexpr Payload of(Field field, std::uint32_t component) { return pair(field, component); }
  [[nodiscard]] static constexpr Payload of(Slot slot, std::uint32_t component = 0) { return pair(slot, component); }
  [[nodiscard]] static constexpr Payload of(LightField field, LightId light) { return pair(field, light.index()); }
  [[nodiscard]] static constexpr Payload of(Input input, std::uint32_t axis, std::uint32_t which) {
    return pair(input, axis | which << kAxisBits);
  }

  [[nodiscard]] constexpr float constant() const { return std::bit_cast<float>(word_); }
  [[nodiscard]] constexpr std::uint32_t number() const { return word_; }
  [[nodiscard]] constexpr Field field() const { return static_cast<Field>(low()); }
  [[nodiscard]] constexpr Slot slot() const { return static_cast<Slot>(low()); }
  [[nodiscard]] constexpr LightField light_field() const { return static_cast<LightField>(low()); }
  [[nodiscard]] constexpr Input input() const { return static_cast<Input>(low()); }
  [[nodiscard]] constexpr std::uint32_t component() const { return high(); }
  [[nodiscard]] constexpr LightId light() const { return LightId(high()); }
  [[nodiscard]] constexpr std::uint32_t axis() const { return high() & ((1U << kAxisBits) - 1U); }
  [[nodiscard]] constexpr std::uint32_t which() const { return high() >> kAxisBits; }
  /// All of it, to be hashed.
  [[nodiscard]] constexpr std::uint32_t word() const { return word_; }
  friend constexpr bool operator==(Payload, Payload) = default;

 private:
  static constexpr unsigned kLowBits = 8, kAxisBits = 4;
  constexpr explicit Payload(std::uint32_t word) : word_(word) {}
  template <class Low>
  [[nodiscard]] static constexpr Payload pair(Low low, std::uint32_t high) {
    return Payload(static_cast<std::uint32_t>(low) | high << kLowBits);
  }
  [[nodiscard]] constexpr std::uint32_t low() const { return word_ & ((1U << kLowBits) - 1U); }
  [[nodiscard]] constexpr std::uint32_t high() const { return word_ >> kLowBits; }
  std::uint32_t word_ = 0;
};
static_assert(sizeof(Payload) == sizeof(std::uint32_t));

/// A value of an expression: an index into its code.
using Value = std::uint32_t;

struct Instruction {
  Op op = Op::constant;
  Payload payload;
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
/// By value: is it the same for all samples of a batch?
[[nodiscard]] std::vector<bool> find_uniform(const Code& code);

/// Straight-line code over registers, uniform part first.
struct Kernel {
  struct Step {
    Op op;
    Payload payload;
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
