#include "color/compress/split.h"

#include <algorithm>

#include "color/expression/columns.h"

namespace relook {
namespace {

/// Of the lamp at hand: its colour, and that of filters before it.
struct LampChanges {
  bool lamp = false, tint = false;
};

class Splitter {
 public:
  Splitter(const ColorProgram& program, const ChangingLeaves& leaves)
      : program_(program), code_(program.code), leaves_(leaves), uniform_(find_uniform(code_)) {
    for (const LightId light : leaves.lights) {
      if (light.index() >= changing_lights_.size()) changing_lights_.resize(light.index() + std::size_t{1});
      changing_lights_[light.index()] = true;
    }
  }

  SplitProgram result() {
    find_changing();
    for (std::size_t sum = 0; sum < program_.sums.size(); ++sum) split_sum(sum);
    const std::vector<bool>& changing = changing_[variant(any_)];
    add_columns(find_columns(code_, uniform_, changing, program_.result));
    for (const SplitSum& sum : split_.sums)
      if (sum.changes_at_first) add_columns(find_columns(code_, uniform_, changing, before(sum)));
    std::ranges::sort(columns_);
    columns_.erase(std::ranges::unique(columns_).begin(), columns_.end());

    const Code rest = with_columns(code_, columns_);
    split_.constants = make_kernel(code_, columns_);
    split_.baked = read_by(columns_);
    split_.residual = make_kernel(rest, {program_.result.begin(), program_.result.end()});
    for (SplitSum& sum : split_.sums)
      if (sum.changes_at_first) sum.stage = make_kernel(rest, {before(sum).begin(), before(sum).end()});
    for (const OpenTerm& term : open_terms_) finish_term(term, rest);
    return std::move(split_);
  }

 private:
  static constexpr std::size_t variant(const LampChanges& changes) {
    return (changes.lamp ? 2U : 0U) + (changes.tint ? 1U : 0U);
  }
  [[nodiscard]] bool may_be(const LampChanges& changes) const {
    return (any_.lamp || !changes.lamp) && (any_.tint || !changes.tint);
  }
  [[nodiscard]] const LampSum::Rgb& before(const SplitSum& sum) const {
    return program_.sums[static_cast<std::size_t>(&sum - split_.sums.data())].before;
  }

  /// Which values change, for each of what may change of a lamp at hand. A sum changes if any lamp may change it.
  void find_changing() {
    any_ = {leaves_.lamps, !leaves_.tints.empty()};
    split_.sums.resize(program_.sums.size());
    for (std::vector<bool>& flags : changing_) flags.resize(code_.size());
    for (Value v = 0; v < code_.size(); ++v) {
      if (code_[v].op == Op::input && code_[v].payload.input() == Input::sum) note_sum(code_[v].payload.which());
      for (const bool lamp : {false, true})
        for (const bool tint : {false, true}) {
          if (!may_be({lamp, tint})) continue;
          std::vector<bool>& flags = changing_[variant({lamp, tint})];
          flags[v] = is_changing(v, {lamp, tint}, flags);
        }
    }
  }
  void note_sum(std::size_t number) {
    const LampSum& sum = program_.sums[number];
    SplitSum& split = split_.sums[number];
    split.changes_at_first = changes(sum.before, any_);
    split.changes = split.changes_at_first || std::ranges::any_of(sum.terms, [&](const auto& term) {
                      return term && changes(*term, any_);
                    });
  }
  [[nodiscard]] bool changes(std::span<const Value> values, const LampChanges& which) const {
    return std::ranges::any_of(values, [&](Value value) { return changing_[variant(which)][value]; });
  }

  [[nodiscard]] bool is_changing(Value v, const LampChanges& of_lamp, const std::vector<bool>& changing) const {
    const Instruction& i = code_[v];
    if (reads_fields(i, leaves_.fields)) return true;
    switch (i.op) {
      case Op::light_field:
        if (!is_color(i.payload.light_field())) return false;
        if (i.payload.light() == kLightAtHand) return of_lamp.lamp;
        return i.payload.light().index() < changing_lights_.size() &&
               changing_lights_[i.payload.light().index()];
      case Op::ambient:
        return leaves_.ambient;
      case Op::environment:
        return leaves_.environment;
      case Op::input:
        if (i.payload.input() == Input::child) return leaves_.children.has(static_cast<Branch>(i.payload.which()));
        if (i.payload.input() == Input::sum) return split_.sums[i.payload.which()].changes;
        if (i.payload.input() != Input::tint) return false;
        return i.payload.which() == kPlaceAtHand ? of_lamp.tint : leaves_.tints.has(i.payload.which());
      case Op::environment_map:
        if (leaves_.environment) return true;
        break;
      default:
        break;
    }
    return any_operand(i, [&](Value operand) { return changing[operand]; });
  }

  /// A term whose columns are known.
  struct OpenTerm {
    std::size_t sum, term, light_term;
    std::vector<Value> own;  // columns that depend on the lamp
  };
  void split_sum(std::size_t number) {
    SplitSum& sum = split_.sums[number];
    if (!sum.changes) return;
    if (!sum.changes_at_first) sum.read = read_by(program_.sums[number].before);
    sum.terms.resize(SplitSum::term(kLightTerms, false, false));
    const std::vector<bool> of_light = find_light_values(code_);
    for (std::size_t t = 0; t < kLightTerms; ++t) {
      const auto& term = program_.sums[number].terms[t];
      if (!term) continue;
      for (const bool lamp : {false, true})
        for (const bool tint : {false, true}) {
          if (!may_be({lamp, tint}) || (tint && !is_filtered(t))) continue;
          OpenTerm open{number, SplitSum::term(t, lamp, tint), t, {}};
          std::vector<Value> of_node;
          for (const Value v : find_columns(code_, uniform_, changing_[variant({lamp, tint})], *term))
            (of_light[v] ? open.own : of_node).push_back(v);
          add_columns(of_node);
          sum.terms[open.term].changes = changes(*term, {lamp, tint});
          open_terms_.push_back(std::move(open));
        }
    }
  }
  void finish_term(const OpenTerm& open, const Code& rest) {
    SplitTerm& term = split_.sums[open.sum].terms[open.term];
    const LampSum::Rgb& outputs = *program_.sums[open.sum].terms[open.light_term];
    term.constants = make_kernel(with_columns(code_, program_.pieces.columns), open.own);
    term.baked = read_by(open.own);
    term.read = read_by(outputs);
    Code code = rest;
    for (std::size_t k = 0; k < open.own.size(); ++k)
      code[open.own[k]] = {Op::column, Payload::number(static_cast<std::uint32_t>(columns_.size() + k)), {}};
    term.residual = make_kernel(code, {outputs.begin(), outputs.end()});
  }
  void add_columns(std::span<const Value> more) { columns_.insert(columns_.end(), more.begin(), more.end()); }

  /// What these values are computed from. The lights are sorted, each once.
  Dependencies read_by(std::span<const Value> values) const {
    std::vector<bool> needed(code_.size());
    const auto need = [&](std::span<const Value> more) {
      for (const Value value : more) needed[value] = true;
    };
    need(values);
    Dependencies read;
    for (Value v = static_cast<Value>(code_.size()); v-- > 0;) {
      if (!needed[v]) continue;
      for (unsigned k = 0; k < operand_count(code_[v].op); ++k) needed[code_[v].operands[k]] = true;
      note(code_[v], read);
      if (code_[v].op != Op::input || code_[v].payload.input() != Input::sum) continue;
      const LampSum& sum = program_.sums[code_[v].payload.which()];
      need(sum.before);
      for (const auto& term : sum.terms)
        if (term) need(*term);
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
        if (i.payload.light() == kLightAtHand)
          read.lamps = true;
        else
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
  std::vector<bool> uniform_;
  std::array<std::vector<bool>, 4> changing_;  // by variant()
  std::vector<bool> changing_lights_;          // by id
  LampChanges any_;
  std::vector<Value> columns_;  // of a node
  std::vector<OpenTerm> open_terms_;
  SplitProgram split_;
};

}  // namespace

SplitProgram split(const ColorProgram& program, const ChangingLeaves& leaves) {
  return Splitter(program, leaves).result();
}

}  // namespace relook
