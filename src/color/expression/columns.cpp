#include "color/expression/columns.h"

#include <algorithm>

namespace relook {
namespace {

/// Cheaper to compute again from columns at hand than to load.
bool is_cheap(Op op) {
  return op == Op::add || op == Op::subtract || op == Op::multiply || op == Op::min || op == Op::max;
}

class ColumnFinder {
 public:
  ColumnFinder(const Code& code, const std::vector<bool>& uniform, const std::vector<bool>& changing)
      : code_(code), uniform_(uniform), changing_(changing), is_column_(code.size()), visited_(code.size()) {}

  std::vector<Value> find(std::span<const Value> wanted) {
    for (const Value value : wanted) demand(value);
    lower_columns();
    std::vector<Value> columns;
    for (Value v = 0; v < code_.size(); ++v)
      if (is_column_[v]) columns.push_back(v);
    return columns;
  }

 private:
  /// Notes what the rest needs of a value: a column, unless it changes or is the same for all samples.
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
        const bool follows = !any_operand(code_[v], [&](Value o) { return !uniform_[o] && !is_column_[o]; });
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

  const Code& code_;
  const std::vector<bool>&uniform_, &changing_;
  std::vector<bool> is_column_, visited_;
};

}  // namespace

bool reads_fields(const Instruction& instruction, FieldMask fields) {
  switch (instruction.op) {
    case Op::material_field:
      return (fields & mask_of(instruction.payload.field())) != 0;
    case Op::slot_color:
      return (fields & color_mask_of(instruction.payload.slot())) != 0;
    case Op::texture:
    case Op::procedural_weight:
      return (fields & mask_of(instruction.payload.slot())) != 0;
    default:
      return false;
  }
}

std::vector<Value> find_columns(const Code& code, const std::vector<bool>& uniform, const std::vector<bool>& changing,
                                std::span<const Value> wanted) {
  return ColumnFinder(code, uniform, changing).find(wanted);
}

Code with_columns(Code code, std::span<const Value> columns) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    code[columns[k]] = {Op::column, Payload::number(static_cast<std::uint32_t>(k)), {}};
  return code;
}

}  // namespace relook
