#include "color/expression/program.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "base/portable_math.h"

namespace relook {
namespace {

float folded(Op op, float a, float b) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::min:
      return a < b ? a : b;
    case Op::max:
      return a > b ? a : b;
    default:
      return 0;
  }
}

}  // namespace

MaterialStructure structure_of(const Material& material) {
  const auto is_positive = [](const Color& c) { return c.x > 0 || c.y > 0 || c.z > 0; };
  MaterialStructure structure{material.model,
                              material.alpha_mode,
                              material.transmission > 0,
                              material.thickness > 0,
                              is_positive(material.sheen_color),
                              material.clearcoat > 0,
                              material.anisotropy > 0,
                              material.iridescence > 0,
                              material.dispersion > 0,
                              0,
                              0};
  for (std::size_t slot = 0; slot < kSlotCount; ++slot) {
    const TextureKind kind = material.slots[slot].kind;
    if (kind != TextureKind::none) structure.textures |= 1U << slot;
    if (kind == TextureKind::procedural) structure.procedurals |= 1U << slot;
  }
  return structure;
}

Value ExpressionBuilder::emit(const Instruction& instruction) {
  const auto [it, is_new] = known_.try_emplace(instruction, static_cast<Value>(code_.size()));
  if (is_new) code_.push_back(instruction);
  return it->second;
}

const MaterialStructure& ExpressionBuilder::note(FieldMask mask) {
  dependencies_.material |= mask;
  return structure_;
}

bool ExpressionBuilder::is_constant(Value value, float* number) const {
  if (code_[value].op != Op::constant) return false;
  *number = code_[value].payload.constant();
  return true;
}

Value ExpressionBuilder::constant(float value) { return emit({Op::constant, Payload::constant(value), {}}); }

Value ExpressionBuilder::field(Field field, unsigned component) {
  static_cast<void>(note(mask_of(field)));
  return emit({Op::material_field, Payload::of(field, component), {}});
}

Value ExpressionBuilder::light(LightId light, LightField field) {
  auto& lights = dependencies_.lights;
  const auto place = std::ranges::lower_bound(lights, light);
  if (place == lights.end() || *place != light) lights.insert(place, light);
  return emit({Op::light_field, Payload::of(field, light), {}});
}

Value ExpressionBuilder::light_at_hand(LightField field) {
  dependencies_.lamps = true;
  return emit({Op::light_field, Payload::of(field, kLightAtHand), {}});
}

LampSum::Rgb ExpressionBuilder::sum(LampSum sum) {
  const auto number = static_cast<std::uint32_t>(sums_.size());
  sums_.push_back(std::move(sum));
  return {input(Input::sum, 0, number), input(Input::sum, 1, number), input(Input::sum, 2, number)};
}

Value ExpressionBuilder::ambient(unsigned component) {
  dependencies_.ambient = true;
  return emit({Op::ambient, Payload::number(component), {}});
}

Value ExpressionBuilder::environment(unsigned component) {
  dependencies_.environment = true;
  return emit({Op::environment, Payload::number(component), {}});
}

Value ExpressionBuilder::input(Input input, unsigned axis, std::uint32_t which) {
  return emit({Op::input, Payload::of(input, axis, which), {}});
}

Value ExpressionBuilder::apply(Op op, Value a, Value b, Value c) {
  float x = 0, y = 0;
  if (operand_count(op) == 2 && op != Op::sheen_albedo && is_constant(a, &x) && is_constant(b, &y))
    return constant(folded(op, x, y));
  return emit({op, {}, {a, b, c, 0, 0}});
}

Instruction ExpressionBuilder::lookup_at(Op op, Slot slot) {
  static_cast<void>(note(mask_of(slot) | kMappingMask));
  const Value at = emit({Op::coordinates, Payload::of(slot), {}});
  Instruction lookup{op, Payload::of(slot), {}};
  for (unsigned k = 0; k < 4; ++k) lookup.operands[k] = channel(at, k);
  return lookup;
}

Value ExpressionBuilder::procedural_channel(Slot slot, unsigned channel) {
  if (channel == 3) return constant(1);
  static_cast<void>(note(color_mask_of(slot)));
  const auto color = [&](unsigned component) { return emit({Op::slot_color, Payload::of(slot, component), {}}); };
  const Value weight = emit(lookup_at(Op::procedural_weight, slot));
  const Value rest = apply(Op::subtract, constant(1), weight);
  return apply(Op::add, apply(Op::multiply, color(channel), rest), apply(Op::multiply, color(channel + 3), weight));
}

Value ExpressionBuilder::texel(Slot slot, unsigned channel) {
  if ((structure_.procedurals >> static_cast<unsigned>(slot) & 1U) != 0) return procedural_channel(slot, channel);
  Instruction lookup = lookup_at(Op::texture, slot);
  lookup.operands[4] = input(Input::footprint);
  return this->channel(emit(lookup), channel);
}

Value ExpressionBuilder::tangent_frame(Slot slot) {
  static_cast<void>(note(mask_of(slot) | kMappingMask));
  return emit({Op::tangent_frame, Payload::of(slot), {}});
}

Value ExpressionBuilder::environment_map(Value x, Value y, Value z) {
  dependencies_.environment = true;
  return emit({Op::environment_map, {}, {x, y, z, 0, 0}});
}

Value ExpressionBuilder::channel(Value lookup, unsigned channel) {
  require(is_lookup(code_[lookup].op), "channel of a lookup");
  return channel == 0 ? lookup : emit({Op::channel, Payload::number(channel), {lookup, 0, 0, 0, 0}});
}

ColorProgram finish(const ExpressionBuilder& builder, const std::array<Value, 4>& result) {
  ColorProgram program;
  program.code = builder.code();
  program.result = result;
  program.sums = builder.sums();
  if (program.sums.empty())
    program.kernel = make_kernel(program.code, {result.begin(), result.end()});
  else
    program.pieces = make_pieces(program.code, program.sums, result);
  program.dependencies = builder.dependencies();
  return program;
}

}  // namespace relook
