// Makes kept terms (kept_terms.h) while PathShader shades a block of trees; inside src/color/path.
#pragma once
#include <span>
#include <vector>

#include "color/path/kept_terms.h"
#include "color/path/path_runner.h"

namespace relook {

class TermKeeper {
 public:
  /// `parameters`: of opaque materials alone. All outlive it.
  TermKeeper(const ColorScene& scene, const ParameterSet& parameters, const TreeBlock& block, KeptTerms& kept);

  /// `steps`: by node, what of light there comes to its parent; `weights`: to the eye.
  void begin(std::span<const Color> steps, std::span<const Color> weights);
  /// Do a node's terms change with its weight? Then terms are to be added even where it has none now.
  [[nodiscard]] bool is_below(std::uint32_t node) const { return is_below_[node] != 0; }
  /// Is it a hit of such a material?
  [[nodiscard]] bool is_source(std::uint32_t node) const { return is_source_[node] != 0; }
  /// A term of a node, if it changes by its weight.
  void add(std::uint32_t node, std::size_t sum, std::uint32_t pixel, const Color& unit) {
    if (is_below(node)) kept_.terms.push_back({place_of(node, sum, pixel), unit});
  }
  /// A term of a hit's own: unit light is a column of its surface times `factor`. `value`: what it is now.
  void add_own(std::uint32_t node, std::size_t sum, std::uint32_t pixel, std::uint32_t column, const Color& factor,
               const Color& value);
  /// Terms of lights: `places` in the list of terms. To be called with those of sources alone.
  void add_lit(std::uint32_t number, const PathBatch& batch, std::span<const TermPlace> places,
               std::span<const LightLink* const> links, std::span<const Color> tints, PathRunner& runner);
  [[nodiscard]] TermPlace place_of(std::uint32_t node, std::size_t sum, std::uint32_t pixel) const {
    return {slot_[node], static_cast<std::uint16_t>(pixel), static_cast<std::uint16_t>(sum)};
  }
  /// The columns of all sources.
  void keep_columns(PathRunner& runner);

 private:
  [[nodiscard]] FieldMask fields_of(const RayNode& node) const {
    return node.object.is_none() ? 0 : parameters_.fields_of(scene_.scene().object(node.object).material);
  }
  [[nodiscard]] const std::shared_ptr<const PathSplit>& split_of(std::uint32_t number, PathRunner& runner) const {
    return runner.split_of(number, parameters_.fields_of(runner.program(number).material));
  }

  const ColorScene& scene_;
  const ParameterSet& parameters_;
  const TreeBlock& block_;
  KeptTerms& kept_;
  std::vector<std::uint8_t> is_source_, is_below_;   // by node
  std::vector<std::uint32_t> slot_, batch_, lane_;   // by node: in kept_; of sources: place among hits
};

}  // namespace relook
