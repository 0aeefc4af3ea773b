#include "color/program.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "base/portable_math.h"

namespace relook {
namespace {

unsigned operand_count(Op op) {
  switch (op) {
    case Op::constant:
    case Op::material_field:
    case Op::light_field:
    case Op::ambient:
    case Op::environment:
    case Op::input:
    case Op::coordinates:
    case Op::tangent_frame:
      return 0;
    case Op::sqrt:
    case Op::exp2:
    case Op::log2:
    case Op::channel:
      return 1;
    case Op::add:
    case Op::subtract:
    case Op::multiply:
    case Op::divide:
    case Op::min:
    case Op::max:
    case Op::sheen_albedo:
      return 2;
    case Op::if_positive:
    case Op::environment_map:
      return 3;
    case Op::texture:
      return 5;
  }
  return 0;
}

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

/// Number of registers that an instruction writes.
unsigned result_count(Op op) {
  if (op == Op::tangent_frame) return 6;
  return op == Op::coordinates || op == Op::texture || op == Op::environment_map ? 4 : 1;
}
bool is_lookup(Op op) { return result_count(op) > 1; }

/// Gives registers to values in order of first use and takes them back after the last. A lookup takes several in a row.
class RegisterFile {
 public:
  std::uint16_t take(unsigned count) {
    if (count == 1 && !free_.empty()) {
      const std::uint16_t last = free_.back();
      free_.pop_back();
      return last;
    }
    const auto first = static_cast<std::uint16_t>(size_);
    size_ += count;
    require(size_ <= 0xFFFF, "a colour program fits its registers");
    return first;
  }
  void release(std::uint16_t reg) { free_.push_back(reg); }
  [[nodiscard]] std::uint16_t size() const { return static_cast<std::uint16_t>(size_); }

 private:
  unsigned size_ = 0;
  std::vector<std::uint16_t> free_;
};

}  // namespace

MaterialStructure structure_of(const Material& material) {
  const auto is_positive = [](const Color& c) { return c.x > 0 || c.y > 0 || c.z > 0; };
  MaterialStructure structure{material.model,
                              material.alpha_mode,
                              material.transmission > 0,
                              material.thickness > 0,
                              is_positive(material.sheen_color),
                              material.clearcoat > 0,
                              0};
  for (std::size_t slot = 0; slot < kSlotCount; ++slot)
    if (material.slots[slot].kind != TextureKind::none)
      structure.textures = static_cast<std::uint16_t>(structure.textures | 1U << slot);
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
  *number = std::bit_cast<float>(code_[value].payload);
  return true;
}

Value ExpressionBuilder::constant(float value) { return emit({Op::constant, std::bit_cast<std::uint32_t>(value), {}}); }

Value ExpressionBuilder::field(Field field, unsigned component) {
  static_cast<void>(note(mask_of(field)));
  return emit({Op::material_field, static_cast<std::uint32_t>(field) | component << 8, {}});
}

Value ExpressionBuilder::light(LightId light, LightField field) {
  auto& lights = dependencies_.lights;
  if (lights.empty() || lights.back() != light) lights.push_back(light);  // a model takes one lamp after the other
  return emit({Op::light_field, static_cast<std::uint32_t>(field) | light.index() << 8, {}});
}

Value ExpressionBuilder::ambient(unsigned component) {
  dependencies_.ambient = true;
  return emit({Op::ambient, component, {}});
}

Value ExpressionBuilder::environment(unsigned component) {
  dependencies_.environment = true;
  return emit({Op::environment, component, {}});
}

Value ExpressionBuilder::input(Input input, unsigned detail) {
  return emit({Op::input, static_cast<std::uint32_t>(input) | detail << 8, {}});
}

Value ExpressionBuilder::apply(Op op, Value a, Value b, Value c) {
  float x = 0, y = 0;
  if (operand_count(op) == 2 && op != Op::sheen_albedo && is_constant(a, &x) && is_constant(b, &y))
    return constant(folded(op, x, y));
  return emit({op, 0, {a, b, c, 0, 0}});
}

Value ExpressionBuilder::texture(Slot slot) {
  static_cast<void>(note(mask_of(slot)));
  const Value at = emit({Op::coordinates, static_cast<std::uint32_t>(slot), {}});
  Instruction lookup{Op::texture, static_cast<std::uint32_t>(slot), {}};
  for (unsigned k = 0; k < 4; ++k) lookup.operands[k] = channel(at, k);
  lookup.operands[4] = input(Input::footprint);
  return emit(lookup);
}

Value ExpressionBuilder::tangent_frame(Slot slot) {
  static_cast<void>(note(mask_of(slot)));
  return emit({Op::tangent_frame, static_cast<std::uint32_t>(slot), {}});
}

Value ExpressionBuilder::environment_map(Value x, Value y, Value z) {
  dependencies_.environment = true;
  return emit({Op::environment_map, 0, {x, y, z, 0, 0}});
}

Value ExpressionBuilder::channel(Value lookup, unsigned channel) {
  require(is_lookup(code_[lookup].op), "channel of a lookup");
  return channel == 0 ? lookup : emit({Op::channel, channel, {lookup, 0, 0, 0, 0}});
}

ColorProgram finish(const ExpressionBuilder& builder, const std::array<Value, 4>& result) {
  const std::vector<Instruction>& code = builder.code();
  // Last use of each value; 0: not needed. Operands come before their users, so one pass backwards finds all.
  std::vector<std::size_t> last_use(code.size(), 0);
  for (Value value : result) last_use[value] = code.size() + 1;
  for (std::size_t i = code.size(); i-- > 0;) {
    if (last_use[i] == 0) continue;
    for (unsigned k = 0; k < operand_count(code[i].op); ++k)
      last_use[code[i].operands[k]] = std::max(last_use[code[i].operands[k]], i + 1);
    // A channel reads its lookup's registers: the lookup lives as long as any channel of it.
    if (code[i].op == Op::channel) {
      std::size_t& lookup = last_use[code[i].operands[0]];
      lookup = std::max(lookup, last_use[i]);
    }
  }
  std::vector<bool> is_uniform(code.size(), false);
  for (std::size_t i = 0; i < code.size(); ++i) {
    const Op op = code[i].op;
    bool uniform = op != Op::input && !is_lookup(op) && op != Op::channel;
    for (unsigned k = 0; k < operand_count(op); ++k) uniform = uniform && is_uniform[code[i].operands[k]];
    is_uniform[i] = uniform;
  }

  ColorProgram program;
  program.dependencies = builder.dependencies();
  RegisterFile registers;
  std::vector<std::uint16_t> place(code.size(), 0);
  const auto step_of = [&](std::size_t i) {
    ColorProgram::Step step{code[i].op, code[i].payload, place[i], {}};
    for (unsigned k = 0; k < operand_count(code[i].op); ++k) step.in[k] = place[code[i].operands[k]];
    return step;
  };
  // Uniform values keep their register for good: they are filled once per batch.
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (last_use[i] == 0 || !is_uniform[i]) continue;
    place[i] = registers.take(1);
    program.uniform.push_back(step_of(i));
  }
  // Values by where they end, as lists: first_end[i] is one that ends at i, next_end[value] the next of these.
  constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> first_end(code.size() + 2, kNone), next_end(code.size(), kNone);
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (last_use[i] == 0 || is_uniform[i] || code[i].op == Op::channel) continue;
    next_end[i] = first_end[last_use[i]];
    first_end[last_use[i]] = i;
  }
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (last_use[i] != 0 && !is_uniform[i]) {
      if (code[i].op == Op::channel) {
        place[i] = static_cast<std::uint16_t>(place[code[i].operands[0]] + code[i].payload);
      } else {
        place[i] = registers.take(result_count(code[i].op));
        program.varying.push_back(step_of(i));
      }
    }
    for (std::size_t ended = first_end[i + 1]; ended != kNone; ended = next_end[ended])
      for (unsigned k = 0; k < result_count(code[ended].op); ++k)
        registers.release(static_cast<std::uint16_t>(place[ended] + k));
  }
  program.registers = registers.size();
  for (std::size_t c = 0; c < 4; ++c) program.result[c] = place[result[c]];
  return program;
}

}  // namespace relook
