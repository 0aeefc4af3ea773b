#include "color/path/vertex_shader.h"

namespace relook {

VertexShader::VertexShader(const ColorScene& scene, PathPrograms& programs, const SumPlaces& places)
    : scene_(scene), places_(places), met_(scene), runner_(scene, programs) {}

void VertexShader::add_lit(const TileVertices::Batch& batch, const TreeBlock& block, std::span<const LitTerm> terms,
                           TileSums& sums) {
  shade_filters(block, runner_, tints_);
  terms_.clear();
  for (const LitTerm& lit : terms) terms_.push_back(&lit.term);
  const PathBatch source{scene_, block, false, {}, terms_};
  const Parameters parameters{scene_.scene(), batch.program.material};
  KernelRun<PathBatch> kernel(batch.program.program->kernel, parameters, source, terms.size(), runner_.scratch());
  for (std::size_t first = 0; first < terms.size(); first += kLanes) {
    const std::size_t lanes = std::min(kLanes, terms.size() - first);
    kernel.run(first, lanes);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const LitTerm& lit = terms[first + lane];
      Color unit = from_lanes(kernel, 0, lane);
      for (std::uint32_t f = 0; f < lit.filters; ++f) unit = unit * tints_[lit.first_filter + f];
      const std::uint32_t light = lit.term.light;
      sums.add(places_.sum_of[light], lit.pixel, lit.weight * (unit * lit.scale) * places_.colors[light]);
    }
  }
}

void VertexShader::add_met(std::span<const MetRay> rays, bool leave, const Wanted& wanted, TileSums& sums) {
  RayNode node(kNoNode, 0, {});
  node.object = leave ? ObjectId::none() : ObjectId(0);  // no more is read of it
  const auto is_wanted = [&](std::uint32_t place) { return wanted.lights[place] != 0; };
  const MetLights::Surroundings around{wanted.sums[places_.sum_of[places_.background]] != 0,
                                       wanted.sums[places_.sum_of[places_.sky]] != 0, is_wanted(met_.suns())};
  for (const MetRay& ray : rays) {
    ray.restore(node);
    const auto add = [&](std::uint32_t source, const Color& unit) {
      sums.add(places_.sum_of[source], ray.pixel, ray.weight * unit * places_.colors[source]);
    };
    met_.cross(node, is_wanted, add);
    if (!leave) continue;
    const MetLights::UnitLight unit = met_.surroundings(node, around);
    if (unit.has.background) add(places_.background, unit.background);
    if (unit.has.sky) add(places_.sky, unit.sky);
    if (unit.has.suns) add(met_.suns(), unit.suns);
  }
}

void shade_filters(const TreeBlock& block, PathRunner& runner, std::vector<Color>& tints) {
  if (block.filters.empty()) return;
  tints.resize(block.filters.size());
  runner.begin();
  for (std::uint32_t i = 0; i < block.filters.size(); ++i) {
    const FilterNode& filter = block.filters[i];
    runner.add(i, runner.number_of(runner.key_of(PathPiece::filter, filter.object, filter.point.inside)));
  }
  runner.run(block, true, {}, [&](const auto& kernel, const PathKey&, std::span<const std::uint32_t> chosen) {
    for (std::size_t lane = 0; lane < chosen.size(); ++lane)
      tints[runner.item(chosen[lane])] = from_lanes(kernel, 0, lane);
  });
}

}  // namespace relook
