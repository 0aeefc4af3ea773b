// Colour programs: the expression of a colour tree's node (paper 2.1) in a form that runs over many samples at once.
// Leaves are constants, parameters (pointers into the scene) and inputs (per-sample constants); inner nodes are n-ary
// functions. Equal subexpressions are shared; operations on two constants are folded; nothing is re-associated.
#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "color/expression/expression_code.h"
#include "color/expression/field.h"
#include "color/expression/pieces.h"

namespace relook {

struct InstructionHash {
  std::size_t operator()(const Instruction& instruction) const {
    std::uint64_t hash = static_cast<std::uint64_t>(instruction.op) << 32 | instruction.payload.word();
    for (Value operand : instruction.operands) hash = (hash ^ operand) * 0x9E3779B97F4A7C15ULL;
    return hash ^ (hash >> 29);
  }
};

/// What an expression reads: an edit that changes none of it cannot change the colour.
struct Dependencies {
  FieldMask material = 0;  // of the node's own material, its structure included
  bool ambient = false, environment = false;
  std::vector<LightId> lights;  // whose colour parameters are read; increasing, each once
  bool lamps = false;           // likewise those of all lamps that reach the node
};

/// What of a material decides the shape of its expressions: materials with equal structures share programs.
struct MaterialStructure {
  IlluminationModel model = IlluminationModel::metallic_roughness;
  AlphaMode alpha_mode = AlphaMode::opaque;
  // The value is not zero:
  bool transmits = false, thick = false, sheen = false, clearcoat = false, anisotropic = false, iridescent = false,
       disperses = false;
  std::uint32_t textures = 0, procedurals = 0;  // bit per Slot: there is one; procedural
  auto operator<=>(const MaterialStructure&) const = default;
};
static_assert(kSlotCount <= 32);
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
  [[nodiscard]] Value light_at_hand(LightField field);
  /// The channels of a sum with the light of all lamps.
  [[nodiscard]] LampSum::Rgb sum(LampSum sum);
  [[nodiscard]] Value ambient(unsigned component);
  [[nodiscard]] Value environment(unsigned component);
  [[nodiscard]] Value input(Input input, unsigned axis = 0, std::uint32_t which = 0);
  [[nodiscard]] Value apply(Op op, Value a, Value b = 0, Value c = 0);
  /// One channel of what a texture slot holds. Requires has_texture(slot).
  [[nodiscard]] Value texel(Slot slot, unsigned channel);
  /// First result of a lookup; channel(lookup, k) gives the others.
  [[nodiscard]] Value tangent_frame(Slot slot);
  [[nodiscard]] Value environment_map(Value x, Value y, Value z);
  [[nodiscard]] Value channel(Value lookup, unsigned channel);

  /// The structure for decisions about the expression's shape; what is looked at must be noted as a dependency.
  [[nodiscard]] const MaterialStructure& shape(Field field) { return note(mask_of(field)); }
  [[nodiscard]] bool has_texture(Slot slot) {
    return (note(mask_of(slot)).textures >> static_cast<unsigned>(slot) & 1U) != 0;
  }
  [[nodiscard]] const Scene& scene() const { return scene_; }

  [[nodiscard]] const Code& code() const { return code_; }
  [[nodiscard]] const std::vector<LampSum>& sums() const { return sums_; }
  [[nodiscard]] const Dependencies& dependencies() const { return dependencies_; }

 private:
  static constexpr std::size_t kUsualLength = 512;

  const MaterialStructure& note(FieldMask mask);
  /// The operands of a lookup: where to look.
  [[nodiscard]] Instruction lookup_at(Op op, Slot slot);
  [[nodiscard]] Value procedural_channel(Slot slot, unsigned channel);
  Value emit(const Instruction& instruction);
  [[nodiscard]] bool is_constant(Value value, float* number) const;

  const Scene& scene_;
  MaterialStructure structure_;
  Code code_;
  std::unordered_map<Instruction, Value, InstructionHash> known_;
  std::vector<LampSum> sums_;
  Dependencies dependencies_;
};

/// A finished program: the expression, and the same ready to run, as one kernel or, where lamps add to sums, in pieces.
struct ColorProgram {
  Code code;
  std::array<Value, 4> result{};  // R, G, B, A
  std::vector<LampSum> sums;     // each may read those before it
  Kernel kernel;                  // without sums; outputs: R, G, B, A
  Pieces pieces;                  // with sums
  Dependencies dependencies;
};
[[nodiscard]] ColorProgram finish(const ExpressionBuilder& builder, const std::array<Value, 4>& result);

}  // namespace relook
