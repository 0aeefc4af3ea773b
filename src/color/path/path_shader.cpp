#include "color/path/path_shader.h"

#include <algorithm>

#include "color/path/light_terms.h"
#include "color/path/met_lights.h"
#include "color/path/path_runner.h"
#include "color/path/term_keeper.h"
#include "color/path/vertex_keeper.h"
#include "color/path/vertex_shader.h"
#include "trace/light/emission_source.h"

namespace relook {
namespace {

/// What the program of a hit says of it, beside its branches.
struct HitColumns {
  Color emission, ambient, unlit;
  float coverage = 0;
};

bool is_black(const Color& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

}  // namespace

struct PathShader::Impl {
  Impl(const ColorScene& s, PathPrograms& programs, const SumPlaces& of_sums)
      : scene(s), places(of_sums), met(s), runner(s, programs) {
    emission_of.resize(scene.scene().materials.size(), kNoNode);
    for (std::uint32_t place = 0; place < scene.light_order().size(); ++place) {
      const Light& light = scene.scene().light(scene.light_order()[place]);
      if (light.kind == LightKind::emission) emission_of[light.material.index()] = place;
    }
  }

  void shade(const TreeBlock& trees, std::uint32_t samples, TermSign sign, TileSums& tile, const Wanted& asked,
             TermKeeper* of_terms) {
    block = &trees;
    wanted = asked;
    samples_of_pixel = samples;
    sums = &tile;
    is_added = sign == TermSign::add;
    keeper = of_terms;
    shade_filters(trees, runner, tints);
    find_weights();
    add_own_terms();
    add_light_terms();
  }
  void shade_keeping(const TreeBlock& trees, std::uint32_t samples, TileSums& tile, const Wanted& asked,
                     TileVertices& kept) {
    keeps_vertices = true;
    shade(trees, samples, TermSign::add, tile, asked, nullptr);
    keeps_vertices = false;
    keep_vertices(scene, {trees, weights, lit_columns, first_lit_column, lit_column_count, samples}, runner, kept);
  }
  void keep(const TreeBlock& trees, std::uint32_t samples, const ParameterSet& parameters, KeptTerms& kept) {
    TermKeeper of_terms(scene, parameters, trees, samples, kept);
    TileSums none;
    shade(trees, samples, TermSign::add, none, {}, &of_terms);
    of_terms.finish();
  }
  [[nodiscard]] std::span<const Color> found_weights() const { return weights; }

 private:
  [[nodiscard]] bool is_whole(const RayNode& node) const {
    return wanted.sums.empty() || (!wanted.whole.empty() && wanted.whole[node.sample] != 0);
  }
  /// Of sources that are no light.
  [[nodiscard]] bool is_wanted(std::uint32_t source, const RayNode& node) const {
    return is_whole(node) || wanted.sums[places.sum_of[source]] != 0;
  }
  [[nodiscard]] bool is_light_wanted(std::uint32_t place, const RayNode& node) const {
    return is_whole(node) || wanted.lights[place] != 0;
  }

  [[nodiscard]] bool is_lit_by(std::uint32_t place, const RayNode& node) const {
    return reaches(block->lights[node.first_light + place].state) && is_light_wanted(place, node);
  }
  [[nodiscard]] bool is_lit(const RayNode& node) const {
    for (std::uint32_t place = 0; place < places.lights(); ++place)
      if (is_lit_by(place, node)) return true;
    return false;
  }

  /// A term: what a node has of unit light of a source.
  void put(std::uint32_t source, std::uint32_t i, const Color& unit) {
    if (keeper != nullptr) return;
    const Color term = weights[i] * unit * places.colors[source];
    if (is_black(term)) return;
    if (is_added)
      sums->add(places.sum_of[source], pixel_of(i), term);
    else
      sums->subtract(places.sum_of[source], pixel_of(i), term);
  }
  [[nodiscard]] std::uint32_t pixel_of(std::uint32_t i) const { return block->nodes[i].sample / samples_of_pixel; }

  /// What a node brings of unit light on the way to it.
  void add(std::uint32_t source, std::uint32_t i, const Color& unit) {
    put(source, i, unit);
    if (keeper != nullptr) keeper->add(i, source, unit);
  }
  /// What a hit brings itself: a column of its surface, times `factor`.
  void add_own(std::uint32_t source, std::uint32_t i, OwnColumn column, const Color& value, const Color& factor) {
    put(source, i, value * factor);
    if (keeper != nullptr) keeper->add_own(i, source, column, factor, value * factor);
  }
  /// Does a node's light come to the eye, now or with other values of what is above?
  [[nodiscard]] bool counts(std::uint32_t i) const {
    return !is_black(weights[i]) || (keeper != nullptr && keeper->is_below(i));
  }

  /// The weight of every ray, and what hits bring themselves; then what of unit light at each node comes to the eye.
  /// Where weights are known, only what lit hits have for lights.
  void find_weights() {
    const std::vector<RayNode>& nodes = block->nodes;
    const bool is_known = !wanted.weights.empty();
    weights.assign(nodes.size(), Color(1, 1, 1));
    columns.resize(nodes.size());
    lit_columns.clear();
    first_lit_column.resize(nodes.size());
    lit_column_count.resize(nodes.size());
    runner.begin();
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].object.is_none()) continue;
      PathKey key = runner.key_of(PathPiece::surface, nodes[i].object, nodes[i].point.inside);
      key.lit = is_lit(nodes[i]) || (keeps_vertices && is_vertex(scene, nodes[i]));
      if (is_known && !key.lit) continue;
      key.gathers = nodes[i].ray.path.gathers;
      if (!is_known) key.children = children_of(nodes[i]);
      runner.add(i, runner.number_of(key));
    }
    runner.run(*block, false, {}, [&](const auto& kernel, const PathKey& key, std::span<const std::uint32_t> chosen) {
      keep_surface(kernel, key, chosen);
    });
    open_shares.assign(nodes.size(), 0);
    if (is_known)
      std::ranges::copy(wanted.weights, weights.begin());
    else
      multiply_weights();
  }

  void keep_surface(const KernelRun<PathBatch>& kernel, const PathKey& key, std::span<const std::uint32_t> chosen) {
    const std::vector<RayNode>& nodes = block->nodes;
    std::size_t column = 0;
    for (std::size_t b = 0; b < kBranches; ++b) {
      if (!key.children.has(static_cast<Branch>(b))) continue;
      for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
        const RayNode& node = nodes[runner.item(chosen[lane])];
        weights[node.child[b]] = from_lanes(kernel, column, lane) * node.coverage.scale();
      }
      ++column;
    }
    for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
      const std::uint32_t i = runner.item(chosen[lane]);
      const float scale = surface_scale(nodes[i]);
      columns[i] = {from_lanes(kernel, column, lane) * scale, from_lanes(kernel, column + 1, lane) * scale,
                    from_lanes(kernel, column + 2, lane) * scale, kernel.output(3 * (column + 3))[lane]};
    }
    if (key.lit) keep_lit_columns(kernel, 3 * (column + 4), chosen);
  }

  void multiply_weights() {
    const std::vector<RayNode>& nodes = block->nodes;
    std::vector<Color> steps;
    if (keeper != nullptr) steps = weights;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
      const RayNode& node = nodes[i];
      if (node.parent == kNoNode) {
        open_shares[i] = 1;
        continue;
      }
      weights[i] = weights[node.parent] * weights[i];
      if (node.ray.branch == Branch::transparency)
        open_shares[i] = open_shares[node.parent] * (1.0F - columns[node.parent].coverage);
    }
    if (keeper == nullptr) return;
    keeper->begin(steps, weights, tints, runner);
  }

  /// What a program yields for lights, from its output `first` on.
  void keep_lit_columns(const KernelRun<PathBatch>& kernel, std::size_t first, std::span<const std::uint32_t> chosen) {
    const std::size_t count = kernel.outputs() - first, start = lit_columns.size();
    lit_columns.resize(start + count * chosen.size());
    for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
      first_lit_column[runner.item(chosen[lane])] = start + lane * count;
      lit_column_count[runner.item(chosen[lane])] = static_cast<std::uint32_t>(count);
    }
    for (std::size_t k = 0; k < count; ++k) {
      const float* from = kernel.output(first + k);
      for (std::size_t lane = 0; lane < chosen.size(); ++lane) lit_columns[start + lane * count + k] = from[lane];
    }
  }

  void add_own_terms() {
    for (std::uint32_t i = 0; i < block->nodes.size(); ++i) {
      const RayNode& node = block->nodes[i];
      if (is_whole(node) && !node.object.is_none()) add_coverage(i);
      if (!counts(i)) continue;
      met.cross(
          node, [&](std::uint32_t place) { return is_light_wanted(place, node); },
          [&](std::uint32_t place, const Color& unit) { add(place, i, unit); });
      if (node.object.is_none())
        add_surroundings(node, i);
      else
        add_hit(node, i);
    }
  }

  void add_coverage(std::uint32_t i) {
    const float coverage = open_shares[i] * columns[i].coverage;
    if (keeper != nullptr)
      keeper->add_coverage(i, open_shares[i], columns[i].coverage);
    else if (!(open_shares[i] > 0))
      return;
    else if (is_added)
      sums->add_coverage(pixel_of(i), coverage);
    else
      sums->subtract_coverage(pixel_of(i), coverage);
  }

  /// Of a ray that leaves the scene.
  void add_surroundings(const RayNode& node, std::uint32_t i) {
    const MetLights::UnitLight unit = met.surroundings(
        node, {is_wanted(places.background, node), is_wanted(places.sky, node), is_light_wanted(met.suns(), node)});
    if (unit.has.background) add(places.background, i, unit.background);
    if (unit.has.sky) add(places.sky, i, unit.sky);
    if (unit.has.suns) add(met.suns(), i, unit.suns);
  }

  void add_hit(const RayNode& node, std::uint32_t i) {
    const HitColumns& own = columns[i];
    const Color one(1, 1, 1);
    if (!node.ray.path.gathers && is_wanted(places.ambient, node))
      add_own(places.ambient, i, OwnColumn::ambient, own.ambient, one);
    const Material& material = scene.scene().material(scene.scene().object(node.object).material);
    if (material.model == IlluminationModel::unlit && is_wanted(places.unlit, node))
      add_own(places.unlit, i, OwnColumn::unlit, own.unlit, one);
    const std::uint32_t place = emission_of[scene.scene().object(node.object).material.index()];
    if (place == kNoNode || !is_light_wanted(place, node)) return;
    const Light& light = scene.scene().light(scene.light_order()[place]);
    const RayLight& source = scene.light(place);
    if (!may_meet(node, source, light)) return;
    const PathState& path = node.ray.path;
    float weight = 1;
    if (path.density > 0)
      weight = met_weight(node, source, source.emission->density(node.object, node.hit.primitive, node.ray.origin,
                                                                 node.ray.direction, node.length));
    add_own(place, i, OwnColumn::emission, own.emission, shown(light.emission, node) * weight);
  }

  /// The image of an emitting surface: as sharp as its light's samples see it, but to the eye.
  [[nodiscard]] Color shown(const TextureSlot& image, const RayNode& node) const {
    const RayObject& object = scene.object(node.object);
    if (image.kind == TextureKind::none) return {1, 1, 1};
    if (!node.ray.path.from.is_none()) return emission_at(image, object, node.hit, node.point.local);
    const Rgba value = texel_at(node, object, image);
    return {value.r, value.g, value.b};
  }

  void add_light_terms() {
    terms.clear();
    runner.begin();
    for (std::uint32_t i = 0; i < block->nodes.size(); ++i) {
      const RayNode& node = block->nodes[i];
      if (node.object.is_none() || !counts(i)) continue;
      std::uint32_t program = kNoNode;
      for (std::uint32_t place = 0; place < places.lights(); ++place) {
        if (!is_lit_by(place, node)) continue;
        auto term = light_term(scene, *block, i, place);
        if (!term) continue;
        term->columns = lit_columns.data() + first_lit_column[i];
        terms.push_back(*term);
        if (program == kNoNode)
          program = runner.number_of(runner.key_of(PathPiece::light, node.object, node.point.inside));
        runner.add(i, program);
      }
    }
    runner.run(*block, false, terms, [&](const auto& kernel, const PathKey&, std::span<const std::uint32_t> chosen) {
      for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
        const LightTerm& term = terms[chosen[lane]];
        const Color value = from_lanes(kernel, 0, lane);
        const LightLink& link = block->lights[block->nodes[term.node].first_light + term.light];
        const Color unit = tinted(value, link) * surface_scale(block->nodes[term.node]);
        put(term.light, term.node, unit);
        if (keeper != nullptr && !keeper->is_source(term.node)) keeper->add_lit(term, value, unit);
      }
    });
    if (keeper != nullptr) keeper->add_lit_sources(terms, runner);
  }

  [[nodiscard]] Color tinted(Color light, const LightLink& link) const {
    if (link.state != ShadowState::filtered) return light;
    for (std::uint32_t f = 0; f < link.filters; ++f) light = light * tints[link.first + f];
    return light;
  }

  const ColorScene& scene;
  const SumPlaces& places;
  std::vector<std::uint32_t> emission_of;  // by MaterialId: place in the light order; kNoNode: it emits nothing
  MetLights met;

  const TreeBlock* block = nullptr;
  std::uint32_t samples_of_pixel = 1;
  TileSums* sums = nullptr;
  bool is_added = true;
  Wanted wanted;
  TermKeeper* keeper = nullptr;
  bool keeps_vertices = false;

  PathRunner runner;
  std::vector<LightTerm> terms;
  std::vector<Color> weights, tints;  // by node, by filter
  std::vector<HitColumns> columns;    // by node
  std::vector<float> lit_columns;     // of lit nodes, those of a node in a row: what programs of lights read
  std::vector<std::size_t> first_lit_column;    // by node, if it is lit
  std::vector<std::uint32_t> lit_column_count;  // likewise
  std::vector<float> open_shares;     // by node: what of the eye's straight ray gets there
};

PathShader::PathShader(const ColorScene& scene, PathPrograms& programs, const SumPlaces& places)
    : impl_(std::make_unique<Impl>(scene, programs, places)) {}
PathShader::~PathShader() = default;

void PathShader::shade(const TreeBlock& block, std::uint32_t samples, TermSign sign, TileSums& sums,
                       const Wanted& wanted) {
  impl_->shade(block, samples, sign, sums, wanted, nullptr);
}

void PathShader::shade_keeping(const TreeBlock& block, std::uint32_t samples, TileSums& sums, const Wanted& wanted,
                               TileVertices& vertices) {
  impl_->shade_keeping(block, samples, sums, wanted, vertices);
}

void PathShader::keep(const TreeBlock& block, std::uint32_t samples, const ParameterSet& parameters, KeptTerms& kept) {
  impl_->keep(block, samples, parameters, kept);
}

std::span<const Color> PathShader::weights() const { return impl_->found_weights(); }

}  // namespace relook
