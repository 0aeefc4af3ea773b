#include "color/expression/pieces.h"

#include <algorithm>

#include "color/expression/columns.h"

namespace relook {
namespace {

bool reads_light(const Instruction& i) {
  if (i.op == Op::light_field) return i.payload.light() == kLightAtHand;
  return i.op == Op::input && i.payload.input() == Input::tint && i.payload.which() == kPlaceAtHand;
}

}  // namespace

std::vector<bool> find_light_values(const Code& code) {
  std::vector<bool> reads(code.size());
  for (Value v = 0; v < code.size(); ++v)
    reads[v] = reads_light(code[v]) || any_operand(code[v], [&](Value operand) { return reads[operand]; });
  return reads;
}

Pieces make_pieces(const Code& code, std::span<const LampSum> sums, const std::array<Value, 4>& result) {
  const std::vector<bool> uniform = find_uniform(code);
  std::vector<bool> changing = find_light_values(code);
  for (Value v = 0; v < code.size(); ++v)
    changing[v] = changing[v] || (code[v].op == Op::input && code[v].payload.input() == Input::sum) ||
                  any_operand(code[v], [&](Value operand) { return changing[operand]; });
  Pieces pieces;
  const auto want = [&](std::span<const Value> wanted) {
    const std::vector<Value> columns = find_columns(code, uniform, changing, wanted);
    pieces.columns.insert(pieces.columns.end(), columns.begin(), columns.end());
  };
  for (const LampSum& sum : sums) {
    want(sum.before);
    for (const auto& term : sum.terms)
      if (term) want(*term);
  }
  want(result);
  std::ranges::sort(pieces.columns);
  const auto repeated = std::ranges::unique(pieces.columns);
  pieces.columns.erase(repeated.begin(), repeated.end());

  pieces.constants = make_kernel(code, pieces.columns);
  const Code rest = with_columns(code, pieces.columns);
  for (const LampSum& sum : sums) {
    pieces.stages.push_back(make_kernel(rest, {sum.before.begin(), sum.before.end()}));
    auto& terms = pieces.terms.emplace_back();
    for (std::size_t t = 0; t < kLightTerms; ++t)
      if (sum.terms[t]) terms[t] = make_kernel(rest, {sum.terms[t]->begin(), sum.terms[t]->end()});
  }
  pieces.stages.push_back(make_kernel(rest, {result.begin(), result.end()}));
  return pieces;
}

}  // namespace relook
