#include "color/path/term_keeper.h"

namespace relook {

TermKeeper::TermKeeper(const ColorScene& scene, const ParameterSet& parameters, const TreeBlock& block, KeptTerms& kept)
    : scene_(scene), parameters_(parameters), block_(block), kept_(kept) {}

void TermKeeper::begin(std::span<const Color> steps, std::span<const Color> weights) {
  const std::size_t count = block_.nodes.size();
  is_source_.assign(count, 0);
  is_below_.assign(count, 0);
  slot_.assign(count, kNoNode);
  for (std::size_t i = 0; i < count; ++i) {
    const RayNode& node = block_.nodes[i];
    is_source_[i] = fields_of(node) != 0 ? 1 : 0;
    if (node.parent != kNoNode) is_below_[i] = is_source_[node.parent] | is_below_[node.parent];
    if (is_source_[i] == 0 && is_below_[i] == 0) continue;
    slot_[i] = static_cast<std::uint32_t>(kept_.nodes.size());
    if (is_below_[i] != 0)
      kept_.nodes.push_back({slot_[node.parent], steps[i]});
    else
      kept_.nodes.push_back({kNoNode, weights[i]});
  }
}

void TermKeeper::add_own(std::uint32_t node, std::size_t sum, std::uint32_t pixel, std::uint32_t column,
                         const Color& factor, const Color& value) {
  if (is_source(node))
    kept_.own_terms.push_back({place_of(node, sum, pixel), batch_[node], lane_[node], column, factor});
  else
    add(node, sum, pixel, value);
}

void TermKeeper::keep_columns(PathRunner& runner) {
  batch_.assign(block_.nodes.size(), 0);
  lane_.assign(block_.nodes.size(), 0);
  runner.begin();
  for (std::uint32_t i = 0; i < block_.nodes.size(); ++i) {
    if (!is_source(i)) continue;
    const RayNode& node = block_.nodes[i];
    PathKey key = runner.key_of(PathPiece::surface, node.object, node.point.inside);
    key.gathers = node.ray.path.gathers;
    key.children = children_of(node);
    runner.add(i, runner.number_of(key));
  }
  runner.for_each_batch(
      block_, false, {}, [&](std::uint32_t number, const PathBatch& batch, std::span<const std::uint32_t> places) {
        KeptTerms::Hits hits;
        hits.program = split_of(number, runner);
        hits.material = runner.program(number).material;
        hits.lanes = places.size();
        const BranchSet branches = runner.key(number).children;
        hits.branches = branches.size();
        for (std::size_t lane = 0; lane < places.size(); ++lane) {
          const std::uint32_t i = runner.item(places[lane]);
          batch_[i] = static_cast<std::uint32_t>(kept_.hits.size());
          lane_[i] = static_cast<std::uint32_t>(lane);
          for (std::size_t b = 0; b < kBranches; ++b)
            if (branches.has(static_cast<Branch>(b))) hits.children.push_back(slot_[block_.nodes[i].child[b]]);
        }
        hits.columns =
            stored_columns(hits.program->constants, runner.parameters(number), batch, places.size(), runner.scratch());
        kept_.hits.push_back(std::move(hits));
      });
}

void TermKeeper::add_lit(std::uint32_t number, const PathBatch& batch, std::span<const TermPlace> places,
                         std::span<const LightLink* const> links, std::span<const Color> tints, PathRunner& runner) {
  KeptTerms::LitHits lit;
  lit.program = split_of(number, runner);
  lit.material = runner.program(number).material;
  lit.places.assign(places.begin(), places.end());
  lit.first_tint.push_back(0);
  for (const LightLink* link : links) {
    if (link->state == ShadowState::filtered)
      for (std::uint32_t f = 0; f < link->filters; ++f) lit.tints.push_back(tints[link->first + f]);
    lit.first_tint.push_back(static_cast<std::uint32_t>(lit.tints.size()));
  }
  lit.columns =
      stored_columns(lit.program->constants, runner.parameters(number), batch, places.size(), runner.scratch());
  kept_.lit_hits.push_back(std::move(lit));
}

}  // namespace relook
