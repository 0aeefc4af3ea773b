#include "color/path/path_shader.h"

#include <algorithm>
#include <unordered_map>

#include "color/node_programs.h"
#include "color/path/light_terms.h"
#include "trace/light/emission_source.h"

namespace relook {
namespace {

/// A short form of PathKey that is cheap to make and compare.
std::uint64_t signature_of(const PathKey& key) {
  return std::uint64_t{key.material.index()} << 32 | std::uint64_t{key.children.bits()} << 8 |
         (key.inside ? 1U : 0U) | (key.vertex_colors ? 2U : 0U) | (key.interface_only ? 4U : 0U) |
         (key.gathers ? 8U : 0U) | static_cast<unsigned>(key.piece) << 4 | (key.blurs ? 128U : 0U) |
         (key.lit ? 64U : 0U);
}

/// What the program of a hit says of it, beside its branches.
struct HitColumns {
  Color emission, ambient, unlit;
  float coverage = 0;
};

Color from_lanes(const KernelRun<PathBatch>& run, std::size_t column, std::size_t lane) {
  return {run.output(3 * column)[lane], run.output(3 * column + 1)[lane], run.output(3 * column + 2)[lane]};
}

/// What is multiplied by coverage counts so much.
float surface_scale(const RayNode& node) { return node.coverage.sees_surface() ? node.coverage.scale() : 0.0F; }

bool is_black(const Color& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

}  // namespace

struct PathShader::Impl {
  Impl(const ColorScene& s, PathPrograms& p, const SumPlaces& of_sums) : scene(s), programs(p), places(of_sums) {
    emission_of.resize(scene.scene().materials.size(), kNoNode);
    for (std::uint32_t place = 0; place < scene.light_order().size(); ++place) {
      const Light& light = scene.scene().light(scene.light_order()[place]);
      if (light.kind == LightKind::emission) emission_of[light.material.index()] = place;
      if (light.kind == LightKind::suns) suns = place;
      if (scene.light(place).shape) shapes.push_back(place);
    }
  }

  void shade(const TreeBlock& trees, std::uint32_t samples, TermSign sign, TileSums& tile,
             const Wanted& asked) {
    block = &trees;
    wanted = asked;
    samples_of_pixel = samples;
    sums = &tile;
    is_added = sign == TermSign::add;
    shade_filters();
    if (wanted.weights.empty()) {
      find_weights();
    } else {
      weights.assign(wanted.weights.begin(), wanted.weights.end());
      columns.resize(weights.size());
      open_shares.assign(weights.size(), 0);
    }
    add_own_terms();
    add_light_terms();
  }
  [[nodiscard]] std::span<const Color> found_weights() const { return weights; }

 private:
  [[nodiscard]] bool is_whole(const RayNode& node) const {
    return wanted.sums.empty() || (!wanted.whole.empty() && wanted.whole[node.sample] != 0);
  }
  [[nodiscard]] bool is_wanted(std::uint32_t sum, const RayNode& node) const {
    return is_whole(node) || wanted.sums[sum] != 0;
  }
  [[nodiscard]] bool is_light_wanted(std::uint32_t place, const RayNode& node) const {
    return is_whole(node) || wanted.lights[place] != 0;
  }

  [[nodiscard]] bool is_lit_by(std::uint32_t place, const RayNode& node) const {
    const ShadowState state = block->lights[node.first_light + place].state;
    return (state == ShadowState::open || state == ShadowState::filtered) && is_light_wanted(place, node);
  }
  [[nodiscard]] bool is_lit(const RayNode& node) const {
    for (std::uint32_t place = 0; place < places.of_light.size(); ++place)
      if (is_lit_by(place, node)) return true;
    return false;
  }

  void put(std::uint32_t sum, const RayNode& node, const Color& term) {
    if (is_black(term)) return;
    const std::uint32_t pixel = node.sample / samples_of_pixel;
    if (is_added)
      sums->add(sum, pixel, term);
    else
      sums->subtract(sum, pixel, term);
  }

  /// Of the light at `place`, for unit light.
  void put_light(std::uint32_t place, const RayNode& node, const Color& term) {
    put(places.of_light[place], node, term * places.colors[place]);
  }

  [[nodiscard]] PathKey key_of(PathPiece piece, ObjectId id, bool inside) const {
    const RayObject& object = scene.object(id);
    PathKey key;
    key.piece = piece;
    key.material = scene.scene().object(id).material;
    key.inside = inside;
    key.vertex_colors = !object.mesh->colors.empty();
    key.interface_only = object.optics.volume && inside;
    key.blurs = object.blurs;
    return key;
  }
  std::uint32_t number_of(const PathKey& key) {
    const auto [it, is_new] = numbers.try_emplace(signature_of(key), static_cast<std::uint32_t>(bound.size()));
    if (is_new) {
      bound.push_back(programs.get(scene.scene(), key));
      keys.push_back(key);
    }
    return it->second;
  }

  /// Runs the programs of batches over their hits, and calls done(run, key, hits of the run).
  template <class Done>
  void run(bool are_filters, std::span<const std::uint32_t> hits, std::span<const LightTerm> of_lights,
           const Done& done) {
    batches.for_each(batch_of, bound.size(), [&](std::size_t number, std::span<const std::uint32_t> chosen) {
      batch_hits.clear();
      batch_terms.clear();
      for (const std::uint32_t i : chosen) {
        batch_hits.push_back(hits[i]);
        if (!of_lights.empty()) batch_terms.push_back(&of_lights[i]);
      }
      const PathBatch batch{scene, *block, are_filters, batch_hits, batch_terms};
      const Parameters parameters{scene.scene(), bound[number].material};
      KernelRun<PathBatch> kernel(*bound[number].kernel, parameters, batch, batch_hits.size(), scratch);
      for (std::size_t first = 0; first < batch_hits.size(); first += kLanes) {
        const std::size_t lanes = std::min(kLanes, batch_hits.size() - first);
        kernel.run(first, lanes);
        done(kernel, keys[number], chosen.subspan(first, lanes));
      }
    });
  }

  void shade_filters() {
    if (block->filters.empty()) return;
    tints.resize(block->filters.size());
    batch_of.clear();
    all.clear();
    for (std::uint32_t i = 0; i < block->filters.size(); ++i) {
      all.push_back(i);
      const FilterNode& filter = block->filters[i];
      batch_of.push_back(number_of(key_of(PathPiece::filter, filter.object, filter.point.inside)));
    }
    run(true, all, {}, [&](const auto& kernel, const PathKey&, std::span<const std::uint32_t> chosen) {
      for (std::size_t lane = 0; lane < chosen.size(); ++lane) tints[chosen[lane]] = from_lanes(kernel, 0, lane);
    });
  }

  /// The weight of every ray, and what hits bring themselves; then what of unit light at each node comes to the eye.
  void find_weights() {
    const std::vector<RayNode>& nodes = block->nodes;
    weights.assign(nodes.size(), Color(1, 1, 1));
    columns.resize(nodes.size());
    lit_columns.clear();
    first_lit_column.resize(nodes.size());
    batch_of.clear();
    all.clear();
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].object.is_none()) continue;
      all.push_back(i);
      PathKey key = key_of(PathPiece::surface, nodes[i].object, nodes[i].point.inside);
      key.gathers = nodes[i].ray.path.gathers;
      key.children = children_of(nodes[i]);
      key.lit = is_lit(nodes[i]);
      batch_of.push_back(number_of(key));
    }
    run(false, all, {}, [&](const auto& kernel, const PathKey& key, std::span<const std::uint32_t> chosen) {
      std::size_t column = 0;
      for (std::size_t b = 0; b < kBranches; ++b) {
        if (!key.children.has(static_cast<Branch>(b))) continue;
        for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
          const RayNode& node = nodes[all[chosen[lane]]];
          weights[node.child[b]] = from_lanes(kernel, column, lane) * node.coverage.scale();
        }
        ++column;
      }
      for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
        const float scale = surface_scale(nodes[all[chosen[lane]]]);
        columns[all[chosen[lane]]] = {from_lanes(kernel, column, lane) * scale,
                                      from_lanes(kernel, column + 1, lane) * scale,
                                      from_lanes(kernel, column + 2, lane) * scale,
                                      kernel.output(3 * (column + 3))[lane]};
      }
      if (key.lit) keep_lit_columns(kernel, 3 * (column + 4), chosen);
    });
    open_shares.assign(nodes.size(), 0);
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
  }

  /// What a program yields for lights, from its output `first` on.
  void keep_lit_columns(const KernelRun<PathBatch>& kernel, std::size_t first, std::span<const std::uint32_t> chosen) {
    const std::size_t count = kernel.outputs() - first, start = lit_columns.size();
    lit_columns.resize(start + count * chosen.size());
    for (std::size_t lane = 0; lane < chosen.size(); ++lane) first_lit_column[all[chosen[lane]]] = start + lane * count;
    for (std::size_t k = 0; k < count; ++k) {
      const float* from = kernel.output(first + k);
      for (std::size_t lane = 0; lane < chosen.size(); ++lane) lit_columns[start + lane * count + k] = from[lane];
    }
  }

  void add_own_terms() {
    for (std::uint32_t i = 0; i < block->nodes.size(); ++i) {
      const RayNode& node = block->nodes[i];
      if (is_whole(node) && !node.object.is_none() && open_shares[i] > 0) add_coverage(node, i);
      if (is_black(weights[i])) continue;
      for (const std::uint32_t place : shapes) add_crossed(node, i, place);
      if (node.object.is_none())
        add_surroundings(node, i);
      else
        add_hit(node, i);
    }
  }

  void add_coverage(const RayNode& node, std::uint32_t i) {
    const float coverage = open_shares[i] * columns[i].coverage;
    const std::uint32_t pixel = node.sample / samples_of_pixel;
    if (is_added)
      sums->add_coverage(pixel, coverage);
    else
      sums->subtract_coverage(pixel, coverage);
  }

  void add_crossed(const RayNode& node, std::uint32_t i, std::uint32_t place) {
    const Light& light = scene.scene().light(scene.light_order()[place]);
    if (!is_light_wanted(place, node) || !may_meet(node, scene.light(place), light)) return;
    if (const auto radiance = crossed(node, scene.light(place), light)) put_light(place, node, weights[i] * *radiance);
  }

  /// Of a ray that leaves the scene.
  void add_surroundings(const RayNode& node, std::uint32_t i) {
    const PathState& path = node.ray.path;
    if (path.is_eye && scene.scene().environment.background) {
      if (is_wanted(places.background, node)) put(places.background, node, weights[i] * background(node.ray.direction));
      return;
    }
    const RayLight& light = scene.light(suns);
    if (!is_wanted(places.sky, node) && !is_light_wanted(suns, node)) return;
    const Direction way = to_image(node.ray.direction, light.sine, light.cosine);
    const EnvironmentLight::Parts parts = scene.environment()->parts(way);
    if (is_wanted(places.sky, node)) put(places.sky, node, weights[i] * parts.sky);
    if (is_black(parts.suns) || !is_light_wanted(suns, node)) return;
    if (!may_meet(node, light, scene.scene().light(scene.light_order()[suns]))) return;
    const float weight = path.density > 0 ? met_weight(node, light, scene.environment()->density(way)) : 1.0F;
    put_light(suns, node, weights[i] * parts.suns * weight);
  }

  /// Radiance for unit tint.
  [[nodiscard]] Color background(const Direction& way) const {
    const Background& behind = *scene.scene().environment.background;
    if (!behind.image) return {1, 1, 1};
    const float turns = behind.rotation * 0.15915494F;
    const Direction local = to_image(way, portable_sin_turns(turns), portable_cos_turns(turns));
    const Rgba texel = sample(*behind.image, environment_uv(local), 0, {Wrap::repeat, Wrap::clamp});
    return {texel.r, texel.g, texel.b};
  }

  void add_hit(const RayNode& node, std::uint32_t i) {
    const HitColumns& own = columns[i];
    if (is_wanted(places.ambient, node)) put(places.ambient, node, weights[i] * own.ambient);
    if (is_wanted(places.unlit, node)) put(places.unlit, node, weights[i] * own.unlit);
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
    put_light(place, node, weights[i] * own.emission * shown(light.emission, node) * weight);
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
    batch_of.clear();
    all.clear();
    for (std::uint32_t i = 0; i < block->nodes.size(); ++i) {
      const RayNode& node = block->nodes[i];
      if (node.object.is_none() || is_black(weights[i])) continue;
      std::uint32_t program = kNoNode;
      for (std::uint32_t place = 0; place < places.of_light.size(); ++place) {
        if (!is_lit_by(place, node)) continue;
        auto term = light_term(scene, *block, i, place);
        if (!term) continue;
        term->columns = lit_columns.data() + first_lit_column[i];
        all.push_back(i);
        terms.push_back(*term);
        if (program == kNoNode) program = number_of(key_of(PathPiece::light, node.object, node.point.inside));
        batch_of.push_back(program);
      }
    }
    run(false, all, terms, [&](const auto& kernel, const PathKey&, std::span<const std::uint32_t> chosen) {
      for (std::size_t lane = 0; lane < chosen.size(); ++lane) {
        const LightTerm& term = terms[chosen[lane]];
        const RayNode& node = block->nodes[term.node];
        const Color light = tinted(from_lanes(kernel, 0, lane), block->lights[node.first_light + term.light]);
        put_light(term.light, node, weights[term.node] * (light * surface_scale(node)));
      }
    });
  }

  [[nodiscard]] Color tinted(Color light, const LightLink& link) const {
    if (link.state != ShadowState::filtered) return light;
    for (std::uint32_t f = 0; f < link.filters; ++f) light = light * tints[link.first + f];
    return light;
  }

  const ColorScene& scene;
  PathPrograms& programs;
  const SumPlaces& places;
  std::vector<std::uint32_t> emission_of;  // by MaterialId: place in the light order; kNoNode: it emits nothing
  std::vector<std::uint32_t> shapes;       // places of lights with a shape
  std::uint32_t suns = 0;                  // its place

  const TreeBlock* block = nullptr;
  std::uint32_t samples_of_pixel = 1;
  TileSums* sums = nullptr;
  bool is_added = true;
  Wanted wanted;

  std::unordered_map<std::uint64_t, std::uint32_t> numbers;  // by signature: of a program
  std::vector<BoundPathProgram> bound;
  std::vector<PathKey> keys;
  Batches batches;
  std::vector<std::uint32_t> batch_of, all, batch_hits;
  std::vector<const LightTerm*> batch_terms;
  std::vector<LightTerm> terms;
  std::vector<Color> weights, tints;  // by node, by filter
  std::vector<HitColumns> columns;    // by node
  std::vector<float> lit_columns;     // of lit nodes, those of a node in a row: what programs of lights read
  std::vector<std::size_t> first_lit_column;  // by node, if it is lit
  std::vector<float> open_shares;     // by node: what of the eye's straight ray gets there
  Scratch scratch;
};

PathShader::PathShader(const ColorScene& scene, PathPrograms& programs, const SumPlaces& places)
    : impl_(std::make_unique<Impl>(scene, programs, places)) {}
PathShader::~PathShader() = default;

void PathShader::shade(const TreeBlock& block, std::uint32_t samples, TermSign sign, TileSums& sums,
                       const Wanted& wanted) {
  impl_->shade(block, samples, sign, sums, wanted);
}

std::span<const Color> PathShader::weights() const { return impl_->found_weights(); }

}  // namespace relook
