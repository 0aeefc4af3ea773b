#include "color/path/term_keeper.h"

#include <algorithm>

namespace relook {
namespace {

const Color kWhole(1, 1, 1);

}  // namespace

TermKeeper::TermKeeper(const ColorScene& scene, const ParameterSet& parameters, const TreeBlock& block,
                       std::uint32_t samples_of_pixel, KeptTerms& kept)
    : scene_(scene), parameters_(parameters), block_(block), samples_of_pixel_(samples_of_pixel), kept_(kept) {
  kept_.constants.push_back(kWhole);
}

void TermKeeper::begin(std::span<const Color> steps, std::span<const Color> weights, std::span<const Color> tints,
                       PathRunner& runner) {
  const std::size_t count = block_.nodes.size();
  tints_ = tints;
  is_source_.assign(count, 0);
  is_below_.assign(count, 0);
  slot_.assign(count, kNoNode);
  opening_.assign(count, kNoNode);
  for (std::size_t i = 0; i < count; ++i) {
    const RayNode& node = block_.nodes[i];
    is_source_[i] = fields_of(node.object) != 0 ? 1 : 0;
    if (node.parent != kNoNode) is_below_[i] = is_source_[node.parent] | is_below_[node.parent];
  }
  add_hits(runner);
  add_filters(runner);
  for (std::uint32_t i = 0; i < count; ++i) {
    const RayNode& node = block_.nodes[i];
    if (!is_source(i) && !is_below(i) && !is_tinted(node)) continue;
    slot_[i] = static_cast<std::uint32_t>(kept_.nodes.size());
    const auto pixel = static_cast<std::uint16_t>(node.sample / samples_of_pixel_);
    if (is_below(i))
      kept_.nodes.push_back(
          {slot_[node.parent], is_source(node.parent) ? yielded_weight(i) : constant(steps[i]), pixel});
    else
      kept_.nodes.push_back({kNoNode, constant(weights[i]), pixel});
  }
}

bool TermKeeper::is_tinted(const LightLink& link) const {
  for (std::uint32_t f = 0; f < filters_of(link); ++f)
    if (is_yielded(link.first + f)) return true;
  return false;
}

bool TermKeeper::is_tinted(const RayNode& node) const {
  if (yielded_tint_.empty() || node.object.is_none()) return false;
  const auto links = std::span(block_.lights).subspan(node.first_light, scene_.light_order().size());
  return std::ranges::any_of(links, [&](const LightLink& link) { return is_tinted(link); });
}

FactorId TermKeeper::constant(const Color& value) {
  if (value == kWhole) return FactorId::constant(0);
  kept_.constants.push_back(value);
  return FactorId::constant(kept_.constants.size() - 1);
}

FactorId TermKeeper::yielded_weight(std::uint32_t node) const {
  const RayNode& parent = block_.nodes[block_.nodes[node].parent];
  std::size_t column = 0;
  for (std::size_t b = 0; parent.child[b] != node; ++b)
    if (parent.child[b] != kNoNode) ++column;
  return yielded(block_.nodes[node].parent, column);
}

std::uint32_t TermKeeper::add_batch(std::uint32_t number, const PathBatch& batch, std::size_t lanes,
                                    PathRunner& runner) {
  const MaterialId material = runner.program(number).material;
  const auto& split = runner.split_of(number, parameters_.fields_of(material));
  kept_.batches.push_back(
      {split, material, lanes,
       stored_columns(split->constants, runner.parameters(number), batch, lanes, runner.scratch())});
  const auto first = static_cast<std::uint32_t>(yielded_);
  yielded_ += lanes * kept_.batches.back().width();
  return first;
}

FactorId TermKeeper::own_column(std::uint32_t node, OwnColumn column) const {
  return yielded(node, children_of(block_.nodes[node]).size() + static_cast<std::size_t>(column));
}

void TermKeeper::add_hits(PathRunner& runner) {
  first_yielded_.assign(block_.nodes.size(), kNoNode);
  runner.begin();
  for (std::uint32_t i = 0; i < block_.nodes.size(); ++i) {
    if (!is_source(i)) continue;
    const RayNode& node = block_.nodes[i];
    PathKey key = runner.key_of(PathPiece::surface, node.object, node.point.inside);
    key.gathers = node.ray.path.gathers;
    key.children = children_of(node);
    runner.add(i, runner.number_of(key));
  }
  runner.for_each_batch(block_, false, {},
                        [&](std::uint32_t number, const PathBatch& hits, std::span<const std::uint32_t> places) {
                          const std::uint32_t first = add_batch(number, hits, places.size(), runner);
                          KeptTerms::Batch& batch = kept_.batches.back();
                          const auto width = static_cast<std::uint32_t>(batch.width());
                          for (std::uint32_t lane = 0; lane < places.size(); ++lane)
                            first_yielded_[hits.hits[lane]] = first + lane * width;
                          add_scales(batch, hits.hits);
                        });
}

void TermKeeper::add_scales(KeptTerms::Batch& batch, std::span<const std::uint32_t> nodes) {
  const auto scale_of = [&](std::uint32_t node) { return block_.nodes[node].coverage.scale(); };
  if (std::ranges::all_of(nodes, [&](std::uint32_t node) { return scale_of(node) == 1; })) return;
  for (const std::uint32_t node : nodes) batch.scales.push_back(scale_of(node));
}

void TermKeeper::add_filters(PathRunner& runner) {
  yielded_tint_.clear();
  runner.begin();
  for (std::uint32_t f = 0; f < block_.filters.size(); ++f) {
    const FilterNode& filter = block_.filters[f];
    if (fields_of(filter.object) == 0) continue;
    yielded_tint_.resize(block_.filters.size(), kNoNode);
    runner.add(f, runner.number_of(runner.key_of(PathPiece::filter, filter.object, filter.point.inside)));
  }
  runner.for_each_batch(block_, true, {},
                        [&](std::uint32_t number, const PathBatch& filters, std::span<const std::uint32_t> places) {
                          std::uint32_t next = add_batch(number, filters, places.size(), runner);
                          for (const std::uint32_t filter : filters.hits) yielded_tint_[filter] = next++;
                        });
}

void TermKeeper::add_product(std::uint32_t node, std::uint32_t source, FactorId first) {
  kept_.products.push_back({slot_[node], first, 0, static_cast<std::uint16_t>(source)});
}

void TermKeeper::add_factor(FactorId factor) {
  kept_.more_factors.push_back(factor);
  ++kept_.products.back().more;
}

void TermKeeper::add_own(std::uint32_t node, std::uint32_t source, OwnColumn column, const Color& factor,
                         const Color& unit) {
  if (!is_source(node)) return add(node, source, unit);
  if (!block_.nodes[node].coverage.sees_surface()) return;
  add_product(node, source, own_column(node, column));
  if (factor != kWhole) add_factor(constant(factor));
}

void TermKeeper::add_lit(const LightTerm& term, const Color& value, const Color& unit) {
  if (is_tinted(link_of(term)))
    add_lit_product(term, constant(value));
  else
    add(term.node, term.light, unit);
}

void TermKeeper::add_lit_product(const LightTerm& term, FactorId value) {
  add_product(term.node, term.light, value);
  const LightLink& link = link_of(term);
  for (std::uint32_t f = link.first; f < link.first + filters_of(link); ++f) {
    add_factor(is_yielded(f) ? FactorId::yielded(yielded_tint_[f]) : constant(tints_[f]));
  }
  const float scale = block_.nodes[term.node].coverage.scale();
  if (scale != 1) add_factor(constant({scale, scale, scale}));
}

void TermKeeper::add_lit_sources(std::span<const LightTerm> terms, PathRunner& runner) {
  std::vector<LightTerm> of_sources;
  runner.begin();
  for (const LightTerm& term : terms) {
    if (!is_source(term.node)) continue;
    const RayNode& node = block_.nodes[term.node];
    of_sources.push_back(term);
    runner.add(term.node, runner.number_of(runner.key_of(PathPiece::light, node.object, node.point.inside)));
  }
  runner.for_each_batch(block_, false, of_sources,
                        [&](std::uint32_t number, const PathBatch& batch, std::span<const std::uint32_t> places) {
                          std::uint32_t next = add_batch(number, batch, places.size(), runner);
                          for (const LightTerm* term : batch.terms) add_lit_product(*term, FactorId::yielded(next++));
                        });
}

bool TermKeeper::opens(std::uint32_t node) const {
  return is_source(node) && scene_.object(block_.nodes[node].object).material->alpha_mode == AlphaMode::blend;
}

void TermKeeper::add_coverage(std::uint32_t node, float share, float coverage) {
  const RayNode& hit = block_.nodes[node];
  const bool goes_on = hit.parent != kNoNode && hit.ray.branch == Branch::transparency;
  const std::uint32_t before = goes_on ? opening_[hit.parent] : kNoNode;
  if (before == kNoNode && !(share > 0 && opens(node))) return;
  opening_[node] = static_cast<std::uint32_t>(kept_.openings.size());
  const FactorId own =
      is_source(node) ? own_column(node, OwnColumn::coverage) : constant({coverage, coverage, coverage});
  kept_.openings.push_back({before, share, own, static_cast<std::uint16_t>(hit.sample / samples_of_pixel_)});
}

void TermKeeper::finish() {
  for (const PlainTerm& term : plain_) ++kept_.nodes[term.node].terms;
  std::vector<std::size_t> next;  // by node
  std::size_t count = 0;
  for (const KeptTerms::Node& node : kept_.nodes) {
    next.push_back(count);
    count += node.terms;
  }
  kept_.units.resize(count);
  kept_.sources.resize(count);
  for (const PlainTerm& term : plain_) {
    const std::size_t place = next[term.node]++;
    kept_.units[place] = term.unit;
    kept_.sources[place] = term.source;
  }
  const auto shrink = [](auto&... vectors) { (vectors.shrink_to_fit(), ...); };
  shrink(kept_.constants, kept_.batches, kept_.nodes, kept_.products, kept_.more_factors, kept_.openings);
}

}  // namespace relook
