// Colour programs: the expression of a colour tree's node (paper 2.1) in a form that runs over many samples at once.
// Leaves are constants, parameters (pointers into the scene) and inputs (per-sample constants); inner nodes are n-ary
// functions. Equal subexpressions are shared; constant ones are folded; nothing is re-associated.
#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "color/field.h"

namespace relook {

enum class Op : std::uint8_t {
  // leaves
  constant,        // payload: bits of a float
  material_field,  // payload: Field | component << 8
  light_field,     // payload: LightField | light index << 8
  ambient,         // payload: component
  environment,     // payload: component of color * intensity
  input,           // payload: Input | detail << 8
  // functions of one, two, three values
  sqrt,
  exp2,
  log2,
  add,
  subtract,
  multiply,
  divide,
  min,
  max,
  if_positive,   // a > 0 ? b : c
  sheen_albedo,  // (cosine, roughness)
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
};

/// A value of an expression: an index into ColorProgram::code while building.
using Value = std::uint32_t;

struct Instruction {
  Op op = Op::constant;
  std::uint32_t payload = 0;
  std::array<Value, 5> operands{};
  bool operator==(const Instruction&) const = default;
};

struct InstructionHash {
  std::size_t operator()(const Instruction& instruction) const {
    std::uint64_t hash = static_cast<std::uint64_t>(instruction.op) << 32 | instruction.payload;
    for (Value operand : instruction.operands) hash = (hash ^ operand) * 0x9E3779B97F4A7C15ULL;
    return hash ^ (hash >> 29);
  }
};

/// What an expression reads: an edit that changes none of it cannot change the colour.
struct Dependencies {
  FieldMask material = 0;  // of the node's own material, its structure included
  bool ambient = false, environment = false;
  std::vector<LightId> lights;  // whose colour parameters are read
};

/// What of a material decides the shape of its expressions: materials with equal structures share programs.
struct MaterialStructure {
  IlluminationModel model = IlluminationModel::metallic_roughness;
  AlphaMode alpha_mode = AlphaMode::opaque;
  bool transmits = false, thick = false, sheen = false, clearcoat = false;  // the value is not zero
  std::uint16_t textures = 0;                                               // bit per Slot: there is one
  auto operator<=>(const MaterialStructure&) const = default;
};
static_assert(kSlotCount <= 16);
[[nodiscard]] MaterialStructure structure_of(const Material& material);

/// Builds the expression of one node. All arithmetic happens in the order in which it is written.
class ExpressionBuilder {
 public:
  ExpressionBuilder(const Scene& scene, const MaterialStructure& structure) : scene_(scene), structure_(structure) {
    code_.reserve(kUsualLength);
    known_.reserve(kUsualLength);
  }

  [[nodiscard]] Value constant(float value);
  [[nodiscard]] Value field(Field field, unsigned component = 0);
  [[nodiscard]] Value light(LightId light, LightField field);
  [[nodiscard]] Value ambient(unsigned component);
  [[nodiscard]] Value environment(unsigned component);
  [[nodiscard]] Value input(Input input, unsigned detail = 0);
  [[nodiscard]] Value apply(Op op, Value a, Value b = 0, Value c = 0);
  /// First result of a lookup; channel(lookup, k) gives the others.
  [[nodiscard]] Value texture(Slot slot);
  [[nodiscard]] Value tangent_frame(Slot slot);
  [[nodiscard]] Value environment_map(Value x, Value y, Value z);
  [[nodiscard]] Value channel(Value lookup, unsigned channel);

  /// The structure for decisions about the expression's shape; what is looked at must be noted as a dependency.
  [[nodiscard]] const MaterialStructure& shape(Field field) { return note(mask_of(field)); }
  [[nodiscard]] bool has_texture(Slot slot) {
    return (note(mask_of(slot)).textures >> static_cast<unsigned>(slot) & 1U) != 0;
  }
  [[nodiscard]] const Scene& scene() const { return scene_; }

  [[nodiscard]] const std::vector<Instruction>& code() const { return code_; }
  [[nodiscard]] const Dependencies& dependencies() const { return dependencies_; }

 private:
  static constexpr std::size_t kUsualLength = 512;

  const MaterialStructure& note(FieldMask mask);
  Value emit(const Instruction& instruction);
  [[nodiscard]] bool is_constant(Value value, float* number) const;

  const Scene& scene_;
  MaterialStructure structure_;
  std::vector<Instruction> code_;
  std::unordered_map<Instruction, Value, InstructionHash> known_;
  Dependencies dependencies_;
};

/// A finished program: straight-line code over registers, uniform part first.
struct ColorProgram {
  struct Step {
    Op op;
    std::uint32_t payload;
    std::uint16_t out;
    std::array<std::uint16_t, 5> in;
  };
  std::vector<Step> uniform;  // run once per batch: constants, parameters and what follows from them alone
  std::vector<Step> varying;  // run over all lanes
  std::uint16_t registers = 0;
  std::array<std::uint16_t, 4> result{};  // registers of R, G, B, A
  Dependencies dependencies;
};

/// Drops what `result` does not need, splits uniform from varying code, assigns registers.
[[nodiscard]] ColorProgram finish(const ExpressionBuilder& builder, const std::array<Value, 4>& result);

}  // namespace relook
