#include "color/expression/expression_code.h"

#include <algorithm>

namespace relook {

unsigned operand_count(Op op) {
  switch (op) {
    case Op::constant:
    case Op::material_field:
    case Op::light_field:
    case Op::slot_color:
    case Op::ambient:
    case Op::environment:
    case Op::input:
    case Op::column:
    case Op::coordinates:
    case Op::tangent_frame:
      return 0;
    case Op::sqrt:
    case Op::exp2:
    case Op::log2:
    case Op::cos_turns:
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
    case Op::multiply_add:
    case Op::environment_map:
      return 3;
    case Op::procedural_weight:
      return 4;
    case Op::texture:
      return 5;
  }
  return 0;
}

unsigned result_count(Op op) {
  if (op == Op::tangent_frame) return 6;
  return op == Op::coordinates || op == Op::texture || op == Op::environment_map ? 4 : 1;
}

std::vector<bool> find_uniform(const Code& code) {
  std::vector<bool> is_uniform(code.size(), false);
  for (std::size_t i = 0; i < code.size(); ++i) {
    const Op op = code[i].op;
    bool uniform = op != Op::input && op != Op::column && op != Op::channel && !is_lookup(op);
    for (unsigned k = 0; k < operand_count(op); ++k) uniform = uniform && is_uniform[code[i].operands[k]];
    is_uniform[i] = uniform;
  }
  return is_uniform;
}

namespace {

/// Gives registers to values in order of first use and takes them back after the last. A lookup takes several in a row.
class RegisterFile {
 public:
  std::uint32_t take(unsigned count) {
    if (count == 1 && !free_.empty()) {
      const std::uint32_t last = free_.back();
      free_.pop_back();
      return last;
    }
    const std::uint32_t first = size_;
    size_ += count;
    return first;
  }
  void release(std::uint32_t reg) { free_.push_back(reg); }
  [[nodiscard]] std::uint32_t size() const { return size_; }

 private:
  std::uint32_t size_ = 0;
  std::vector<std::uint32_t> free_;
};

}  // namespace

namespace {

/// Puts products that only a sum needs into the sum: one step instead of two. Neither rounding is left out.
Code fused(Code code, const std::vector<Value>& outputs) {
  const std::vector<bool> is_uniform = find_uniform(code);
  std::vector<bool> is_needed(code.size());
  std::vector<std::uint32_t> uses(code.size(), 0);
  for (Value value : outputs) {
    is_needed[value] = true;
    ++uses[value];
  }
  for (std::size_t i = code.size(); i-- > 0;) {
    if (!is_needed[i]) continue;
    for (unsigned k = 0; k < operand_count(code[i].op); ++k) {
      is_needed[code[i].operands[k]] = true;
      ++uses[code[i].operands[k]];
    }
  }
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i].op != Op::add || is_uniform[i]) continue;
    for (unsigned k = 0; k < 2; ++k) {
      const Instruction product = code[code[i].operands[k]];
      if (product.op != Op::multiply || uses[code[i].operands[k]] != 1) continue;
      code[i] = {Op::multiply_add, {}, {product.operands[0], product.operands[1], code[i].operands[1 - k], 0, 0}};
      break;
    }
  }
  return code;
}

}  // namespace

Kernel make_kernel(const Code& whole_code, const std::vector<Value>& outputs) {
  const Code code = fused(whole_code, outputs);
  // Last use of each value; 0: not needed. Operands come before their users, so one pass backwards finds all.
  std::vector<std::size_t> last_use(code.size(), 0);
  for (Value value : outputs) last_use[value] = code.size() + 1;
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
  const std::vector<bool> is_uniform = find_uniform(code);

  Kernel kernel;
  RegisterFile registers;
  std::vector<std::uint32_t> place(code.size(), 0);
  const auto step_of = [&](std::size_t i) {
    Kernel::Step step{code[i].op, code[i].payload, place[i], {}};
    for (unsigned k = 0; k < operand_count(code[i].op); ++k) step.in[k] = place[code[i].operands[k]];
    return step;
  };
  // Uniform values keep their register for good: they are filled once per batch.
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (last_use[i] == 0 || !is_uniform[i]) continue;
    place[i] = registers.take(1);
    kernel.uniform.push_back(step_of(i));
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
        place[i] = place[code[i].operands[0]] + code[i].payload.number();
      } else {
        place[i] = registers.take(result_count(code[i].op));
        kernel.varying.push_back(step_of(i));
      }
    }
    for (std::size_t ended = first_end[i + 1]; ended != kNone; ended = next_end[ended])
      for (unsigned k = 0; k < result_count(code[ended].op); ++k) registers.release(place[ended] + k);
  }
  kernel.registers = registers.size();
  for (Value value : outputs) kernel.outputs.push_back(place[value]);
  return kernel;
}

}  // namespace relook
