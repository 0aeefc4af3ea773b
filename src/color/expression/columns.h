// Codes cut in two (paper 3.3): values that are stored as columns, and the rest, which follows from the columns, from
// what changes and from parameters. Nothing is re-associated, so the rest yields the bits of the whole. Used for what
// an edit changes (compress/split.h), for what lamps add to a node (pieces.h) and for what lights bring to a vertex
// of a path (path/path_programs.h).
#pragma once
#include <span>
#include <vector>

#include "color/expression/expression_code.h"

namespace relook {

/// Calls test(operand) until it says true for one; false if it never does.
template <class Test>
bool any_operand(const Instruction& instruction, const Test& test) {
  for (unsigned k = 0; k < operand_count(instruction.op); ++k)
    if (test(instruction.operands[k])) return true;
  return false;
}

/// Does an instruction read one of these fields of the material itself, not through its operands?
[[nodiscard]] bool reads_fields(const Instruction& instruction, FieldMask fields);
/// The columns from which `wanted` follow, increasing. `uniform`: by value, find_uniform(code); `changing`: by value, no
/// column may hold it; a value with a changing operand is one.
[[nodiscard]] std::vector<Value> find_columns(const Code& code, const std::vector<bool>& uniform,
                                              const std::vector<bool>& changing, std::span<const Value> wanted);
/// The code with columns as inputs: columns[k] is Op::column k.
[[nodiscard]] Code with_columns(Code code, std::span<const Value> columns);

}  // namespace relook
