// Makes kept terms (kept_terms.h) while PathShader shades a block of trees; inside src/color/path. Hits and filters of
// materials whose parameters change are its sources: what their programs yield are factors.
#pragma once
#include <span>
#include <vector>

#include "color/path/kept_terms.h"
#include "color/path/path_runner.h"

namespace relook {

class TermKeeper {
 public:
  /// `parameters`: of materials alone. All outlive it.
  TermKeeper(const ColorScene& scene, const ParameterSet& parameters, const TreeBlock& block,
             std::uint32_t samples_of_pixel, KeptTerms& kept);

  /// By node: `steps`, what of light there comes to its parent, and `weights`, to the eye. `tints`: by filter.
  void begin(std::span<const Color> steps, std::span<const Color> weights, std::span<const Color> tints,
             PathRunner& runner);
  /// Do a node's terms change with its weight? Then terms are to be added even where it has none now.
  [[nodiscard]] bool is_below(std::uint32_t node) const { return is_below_[node] != 0; }
  /// Is it a hit of such a material?
  [[nodiscard]] bool is_source(std::uint32_t node) const { return is_source_[node] != 0; }

  /// A node's term; `source`: SumPlaces tells whose light it is.
  void add(std::uint32_t node, std::uint32_t source, const Color& unit) {
    if (is_below(node)) plain_.push_back({slot_[node], static_cast<std::uint16_t>(source), unit});
  }
  /// A term of a hit's own: unit light is a column of its surface times `factor`. `unit`: what it is now.
  void add_own(std::uint32_t node, std::uint32_t source, OwnColumn column, const Color& factor, const Color& unit);
  /// A term of a light, which is none of a source's. `value`: what the hit makes of it without tints; `unit`: with all.
  void add_lit(const LightTerm& term, const Color& value, const Color& unit);
  /// Those of sources.
  void add_lit_sources(std::span<const LightTerm> terms, PathRunner& runner);
  /// What the eye's straight ray adds to the coverage at a hit: `share` of it gets there, 0: it is another ray.
  void add_coverage(std::uint32_t node, float share, float coverage);
  /// Is to be called when all terms have been added.
  void finish();

 private:
  struct PlainTerm {
    std::uint32_t node = 0;
    std::uint16_t source = 0;
    Color unit;
  };
  [[nodiscard]] FieldMask fields_of(ObjectId object) const {
    return object.is_none() ? 0 : parameters_.fields_of(scene_.scene().object(object).material);
  }
  [[nodiscard]] const LightLink& link_of(const LightTerm& term) const {
    return block_.lights[block_.nodes[term.node].first_light + term.light];
  }
  /// Does a filter's tint change?
  [[nodiscard]] bool is_yielded(std::uint32_t filter) const {
    return !yielded_tint_.empty() && yielded_tint_[filter] != kNoNode;
  }
  /// Filters of a link.
  [[nodiscard]] std::uint32_t filters_of(const LightLink& link) const {
    return link.state == ShadowState::filtered ? link.filters : 0;
  }
  [[nodiscard]] bool is_tinted(const LightLink& link) const;
  [[nodiscard]] bool is_tinted(const RayNode& node) const;
  [[nodiscard]] FactorId constant(const Color& value);
  /// Of a source's program.
  [[nodiscard]] FactorId yielded(std::uint32_t node, std::size_t column) const {
    return FactorId::yielded(first_yielded_[node] + column);
  }
  [[nodiscard]] FactorId own_column(std::uint32_t node, OwnColumn column) const;
  /// The weight of a source's child.
  [[nodiscard]] FactorId yielded_weight(std::uint32_t node) const;
  /// May the coverage at a hit change?
  [[nodiscard]] bool opens(std::uint32_t node) const;
  std::uint32_t add_batch(std::uint32_t number, const PathBatch& batch, std::size_t lanes, PathRunner& runner);
  void add_hits(PathRunner& runner);
  void add_scales(KeptTerms::Batch& batch, std::span<const std::uint32_t> nodes);
  void add_filters(PathRunner& runner);
  void add_product(std::uint32_t node, std::uint32_t source, FactorId first);
  void add_factor(FactorId factor);
  void add_lit_product(const LightTerm& term, FactorId value);

  const ColorScene& scene_;
  const ParameterSet& parameters_;
  const TreeBlock& block_;
  std::uint32_t samples_of_pixel_;
  KeptTerms& kept_;
  std::span<const Color> tints_;
  std::vector<std::uint8_t> is_source_, is_below_;  // by node
  std::vector<std::uint32_t> slot_;                 // by node: in kept_
  std::vector<std::uint32_t> first_yielded_;        // by node, of sources: factors
  std::vector<std::uint32_t> yielded_tint_;         // by filter: a factor; kNoNode: it stays; empty: all do
  std::vector<std::uint32_t> opening_;              // by node: in kept_; kNoNode: it stays as it is
  std::size_t yielded_ = 0;                         // factors so far
  std::vector<PlainTerm> plain_;                    // in no order
};

}  // namespace relook
