#include "color/compress/split.h"

#include <algorithm>

namespace relook {
namespace {

/// Cheaper to compute again from columns at hand than to load.
bool is_cheap(Op op) {
  return op == Op::add || op == Op::subtract || op == Op::multiply || op == Op::min || op == Op::max;
}

class Splitter {
 public:
  Splitter(const ColorProgram& program, const ChangingLeaves& leaves)
      : program_(program), code_(program.code), leaves_(leaves), uniform_(find_uniform(code_)) {
    for (const LightId light : leaves.lights) {
      if (light.index() >= changing_lights_.size()) changing_lights_.resize(light.index() + std::size_t{1});
      changing_lights_[light.index()] = true;
    }
    changing_.resize(code_.size());
    for (Value v = 0; v < code_.size(); ++v) changing_[v] = is_changing(v);
  }

  SplitProgram result() {
    is_column_.assign(code_.size(), false);
    visited_.assign(code_.size(), false);
    for (Value value : program_.result) demand(value);
    lower_columns();
    std::vector<Value> columns;
    for (Value v = 0; v < code_.size(); ++v)
      if (is_column_[v]) columns.push_back(v);
    SplitProgram split;
    split.constants = make_kernel(code_, columns);
    split.baked = read_by(columns);
    split.residual = residual(columns);
    return split;
  }

 private:
  [[nodiscard]] bool is_changing(Value v) const {
    const Instruction& i = code_[v];
    const auto slot = i.payload.slot();
    switch (i.op) {
      case Op::material_field:
        return (leaves_.fields & mask_of(i.payload.field())) != 0;
      case Op::slot_color:
        return (leaves_.fields & color_mask_of(slot)) != 0;
      case Op::light_field:
        return is_color(i.payload.light_field()) && i.payload.light().index() < changing_lights_.size() &&
               changing_lights_[i.payload.light().index()];
      case Op::ambient:
        return leaves_.ambient;
      case Op::environment:
        return leaves_.environment;
      case Op::input:
        if (i.payload.input() == Input::child) return leaves_.children.has(static_cast<Branch>(i.payload.which()));
        return i.payload.input() == Input::tint && leaves_.tints.has(i.payload.which());
      case Op::texture:
      case Op::procedural_weight:
        if ((leaves_.fields & mask_of(slot)) != 0) return true;
        break;
      case Op::environment_map:
        if (leaves_.environment) return true;
        break;
      default:
        break;
    }
    return any_operand(v, [&](Value operand) { return changing_[operand]; });
  }
  template <class Test>
  bool any_operand(Value v, const Test& test) const {
    for (unsigned k = 0; k < operand_count(code_[v].op); ++k)
      if (test(code_[v].operands[k])) return true;
    return false;
  }

  /// Notes what the residual needs of a value: a column, unless it changes or is the same for all samples.
  void demand(Value v) {
    if (uniform_[v]) return;
    if (!changing_[v]) {
      is_column_[v] = true;
      return;
    }
    if (visited_[v]) return;
    visited_[v] = true;
    for (unsigned k = 0; k < operand_count(code_[v].op); ++k) demand(code_[v].operands[k]);
  }

  /// Puts operands in the place of columns where that makes these fewer: three channels that are one value times a
  /// parameter each need the value alone.
  void lower_columns() {
    std::vector<std::uint32_t> users(code_.size());
    for (bool lowered = true; lowered;) {
      lowered = false;
      std::ranges::fill(users, 0);
      for (Value v = 0; v < code_.size(); ++v)
        if (Value only = 0; is_column_[v] && has_one_operand(v, only)) ++users[only];
      for (Value v = 0; v < code_.size(); ++v) {
        Value only = 0;
        if (!is_column_[v] || !is_cheap(code_[v].op)) continue;
        const bool follows = !any_operand(v, [&](Value o) { return !uniform_[o] && !is_column_[o]; });
        if (follows) {
          is_column_[v] = false;
          lowered = true;
        } else if (has_one_operand(v, only) && users[only] > 1) {
          is_column_[v] = false;
          is_column_[only] = true;
          lowered = true;
        }
      }
    }
  }
  /// The only operand that varies from sample to sample.
  bool has_one_operand(Value v, Value& only) const {
    if (!is_cheap(code_[v].op)) return false;
    unsigned count = 0;
    for (unsigned k = 0; k < operand_count(code_[v].op); ++k) {
      const Value operand = code_[v].operands[k];
      if (uniform_[operand] || (count > 0 && operand == only)) continue;
      only = operand;
      ++count;
    }
    return count == 1;
  }

  /// The program with its columns as inputs.
  Kernel residual(const std::vector<Value>& columns) const {
    Code code = code_;
    for (std::size_t k = 0; k < columns.size(); ++k)
      code[columns[k]] = {Op::column, Payload::number(static_cast<std::uint32_t>(k)), {}};
    return make_kernel(code, {program_.result.begin(), program_.result.end()});
  }

  /// What these values are computed from. The lights are sorted, each once.
  Dependencies read_by(const std::vector<Value>& values) const {
    std::vector<bool> needed(code_.size());
    for (Value value : values) needed[value] = true;
    Dependencies read;
    for (Value v = static_cast<Value>(code_.size()); v-- > 0;) {
      if (!needed[v]) continue;
      for (unsigned k = 0; k < operand_count(code_[v].op); ++k) needed[code_[v].operands[k]] = true;
      note(code_[v], read);
    }
    std::ranges::sort(read.lights);
    read.lights.erase(std::ranges::unique(read.lights).begin(), read.lights.end());
    return read;
  }
  static void note(const Instruction& i, Dependencies& read) {
    const auto slot = i.payload.slot();
    switch (i.op) {
      case Op::material_field:
        read.material |= mask_of(i.payload.field());
        break;
      case Op::slot_color:
        read.material |= color_mask_of(slot);
        break;
      case Op::texture:
      case Op::procedural_weight:
        read.material |= mask_of(slot);
        break;
      case Op::tangent_frame:  // turned as the map is
        read.material |= kMappingMask | mask_of(slot);
        break;
      case Op::coordinates:
        read.material |= kMappingMask;
        break;
      case Op::light_field:  // placement never changes while columns are kept
        if (!is_color(i.payload.light_field())) break;
        read.lights.push_back(i.payload.light());
        break;
      case Op::ambient:
        read.ambient = true;
        break;
      case Op::environment:
      case Op::environment_map:
        read.environment = true;
        break;
      default:
        break;
    }
  }

  const ColorProgram& program_;
  const Code& code_;
  const ChangingLeaves& leaves_;
  std::vector<bool> uniform_, changing_, is_column_, visited_;
  std::vector<bool> changing_lights_;  // by id
};

}  // namespace

SplitProgram split(const ColorProgram& program, const ChangingLeaves& leaves) {
  return Splitter(program, leaves).result();
}

}  // namespace relook
