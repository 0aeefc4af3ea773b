// What is kept between steps of the path integrator: trees that are grown along kept rays are those that are expanded
// with textures and point sets, exchanged terms are those of trees that are shaded before and after an edit, and lights
// give kept vertices the terms that they give trees, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "color/path/light_terms.h"
#include "color/path/vertex_shader.h"
#include "image/sampling.h"
#include "image/tile_light.h"
#include "path_checks.h"
#include "replay/change.h"
#include "scene_parts.h"
#include "trace/tree/pack.h"
#include "trace/update/kept_rays.h"

namespace relook {
namespace {

constexpr TestScene kScenes[] = {TestScene::lights, TestScene::spheres, TestScene::cards, TestScene::study};

/// The trees of all samples of an image's first tile.
struct Trees {
  Trees(const SceneState& scene_state, const ViewOptions& of_view)
      : state(scene_state), view(of_view), rays(state.scene()) {
    image = preprocessed(state.scene(), view);
    rect = tile_rect(0, image.frame.width, image.frame.height);
    const PrimaryRays primaries(rays.camera(), view);
    const GrowScene grow = grow_scene(rays, nullptr, view, 0);
    GrowCounters counters;
    for (std::uint32_t sample = 0; sample < image.trees[0].paths.size(); ++sample)
      roots.push_back(expand_tree(grow, primaries.ray(rect, sample), sample, stored(sample), block, counters));
  }
  [[nodiscard]] StoredTree stored(std::uint32_t sample) const {
    const TileTrees& trees = image.trees[0];
    return {PathCursor(image.paths.words(trees.paths[sample]), {rays.light_order().size(), 0}), trees.hits_of(sample)};
  }

  const SceneState& state;
  ViewOptions view;
  ColorScene rays;
  Image image;
  TileRect rect;
  TreeBlock block;
  std::vector<std::uint32_t> roots;
};

ViewOptions deep_view() {
  ViewOptions view = path_view(4);
  view.diffuse_depth = 2;
  return view;
}

void expect_same_ray(const SpawnedRay& a, const SpawnedRay& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.cone_width, b.cone_width);
  EXPECT_EQ(a.cone_spread, b.cone_spread);
  EXPECT_EQ(a.branch, b.branch);
  EXPECT_EQ(a.channel, b.channel);
  EXPECT_EQ(a.goes_on(), b.goes_on());
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.travelled, b.travelled);
  EXPECT_EQ(a.travelled_slack, b.travelled_slack);
  EXPECT_EQ(a.path.history, b.path.history);
  EXPECT_EQ(a.path.from, b.path.from);
  EXPECT_EQ(a.path.density, b.path.density);
  EXPECT_EQ(a.path.alpha_floor, b.path.alpha_floor);
  EXPECT_EQ(a.path.straight, b.path.straight);
  const auto flags = [](const PathState& path) {
    return std::array{path.is_first, path.is_eye, path.gathers, path.is_shut, path.is_wide, path.is_alone, path.has_lamps};
  };
  EXPECT_EQ(flags(a.path), flags(b.path));
}

void expect_same_lobes(const VertexLobes& a, const VertexLobes& b, const Direction& way) {
  for (const Lobe lobe : {Lobe::diffuse, Lobe::specular, Lobe::coat, Lobe::transmission}) {
    EXPECT_EQ(a.shares.of(lobe), b.shares.of(lobe));
    EXPECT_EQ(a.density(lobe, way), b.density(lobe, way));
    EXPECT_EQ(a.is_wide(lobe), b.is_wide(lobe));
  }
}

class KeptRays : public testing::TestWithParam<TestScene> {};

TEST_P(KeptRays, grow_the_trees_from_which_they_were_taken) {
  const SceneState state = with_integrator(test_scene(GetParam(), 24, 18), Integrator::path);
  const Trees trees(state, deep_view());
  TileRays kept;
  for (const std::uint32_t root : trees.roots) kept.append(trees.block, root);
  const GrowScene grow = grow_scene(trees.rays, nullptr, trees.view, 0);
  const PrimaryRays primaries(trees.rays.camera(), trees.view);
  const RayChange nothing = no_change(trees.rays.light_order()).rays;
  TreeBlock block;
  for (std::uint32_t sample = 0; sample < trees.roots.size(); ++sample) {
    StoredTree stored = trees.stored(sample);
    stored.kept = kept.rays.data() + kept.first[sample];
    GrowCounters counters;
    TreeChange what = TreeChange::all;
    update_tree(grow, nothing, nullptr, primaries.ray(trees.rect, sample), sample, stored, block, counters, what);
    EXPECT_EQ(what, TreeChange::none);
  }
  ASSERT_EQ(block.nodes.size(), trees.block.nodes.size());
  std::size_t scattered = 0;
  for (std::size_t i = 0; i < block.nodes.size() && !HasFailure(); ++i) {
    SCOPED_TRACE("node " + std::to_string(i));
    const RayNode &grown = block.nodes[i], &expanded = trees.block.nodes[i];
    expect_same_ray(grown.ray, expanded.ray);
    EXPECT_EQ(grown.object, expanded.object);
    EXPECT_EQ(grown.child, expanded.child);
    if (grown.object.is_none()) continue;
    EXPECT_EQ(grown.point.position, expanded.point.position);
    EXPECT_EQ(grown.footprint, expanded.footprint);
    EXPECT_EQ(grown.coverage.way, expanded.coverage.way);
    EXPECT_EQ(grown.coverage.bucket, expanded.coverage.bucket);
    const VertexLobes lobes = find_lobes(grown, trees.rays.object(grown.object));
    ASSERT_EQ(lobes.any(), expanded.lobes != kNoNode);
    if (!lobes.any()) continue;
    expect_same_lobes(lobes, trees.block.lobes[expanded.lobes], grown.point.shading);
    ++scattered;
  }
  EXPECT_GT(scattered, trees.roots.size() / 4) << "there is something to see";
}

INSTANTIATE_TEST_SUITE_P(Scenes, KeptRays, testing::ValuesIn(kScenes));

TileSums shaded(const Trees& trees, const ColorScene& scene) {
  TilePrograms programs(scene);
  PathShader shader(scene, programs.path(), programs.places());
  TileSums sums(programs.places().count, trees.rect.pixels());
  shader.shade(trees.block, trees.view.samples, TermSign::add, sums);
  return sums;
}

/// Leaves over leaves over a pane of coloured glass, blinn-phong film, amber and a floor that sees them all by diffuse
/// bounces: tints behind tints, coverage behind scatterings, Beer's law.
SceneState leaves_scene(std::uint32_t width, std::uint32_t height) {
  SceneBuilder scene;
  Json leaf = plain(0.4F, 0.9F, 0.3F, 0, 0.6F);
  leaf["alphaMode"] = "BLEND";
  leaf["doubleSided"] = true;
  leaf["pbrMetallicRoughness"]["baseColorTexture"]["index"] =
      scene.texture("Leaf", scene.image("LeafImage", single_level_image(16, veil_texel)));
  Json pane = plain(0.9F, 0.6F, 0.4F, 0, 0.3F);
  pane["doubleSided"] = true;
  pane["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.9;
  Json film = plain(0.8F, 0.7F, 0.9F, 0, 0.5F);
  film["doubleSided"] = true;
  film["extras"]["relook"] = {{"model", "blinn-phong"}, {"transparency", 0.5}, {"specular", {0.2, 0.2, 0.2}}};
  Json amber = plain(0.95F, 0.9F, 0.8F, 0, 0.02F);
  amber["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  amber["extensions"]["KHR_materials_volume"] = {
      {"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.9, 0.6, 0.2}}};
  const int floor = scene.mesh("Floor", plane_mesh(4, 2), scene.material("Floor", plain(0.6F, 0.6F, 0.6F, 0, 0.7F)));
  const int leaves = scene.mesh("Leaves", plane_mesh(0.9F, 1), scene.material("Leaf", leaf));
  const int glass = scene.mesh("Pane", plane_mesh(0.8F, 1), scene.material("Pane", pane));
  const int sheet = scene.mesh("Film", card_mesh(0.7F, 0.7F), scene.material("Film", film));
  const int ball = scene.mesh("Amber", sphere_mesh(0.5F, 14, 9), scene.material("Amber", amber));
  scene.node("Floor", {{"mesh", floor}});
  scene.node("Leaf1", {{"mesh", leaves}, {"translation", {-0.2, 1.2, 0}}});
  scene.node("Leaf2", {{"mesh", leaves}, {"translation", {0.3, 1.5, 0.2}}});
  scene.node("Pane", {{"mesh", glass}, {"translation", {0, 0.9, 0.4}}});
  scene.node("Film", placed(sheet, -1, 0.7F, 1, 25));
  scene.node("Amber", placed(ball, 0.9F, 0.5F, 0.9F));
  scene.light("Lamp", {{"type", "point"}, {"intensity", 30}, {"color", {1, 0.9, 0.8}}}, {{"translation", {0.4, 4, 1}}});
  scene.light("Sun", {{"type", "directional"}, {"intensity", 1}, {"extras", {{"relook", {{"angle", 0.1}}}}}},
              {{"rotation", {-0.6, 0.1, 0.1, 0.78}}});
  scene.area_light("Window", {{"type", "rect"}, {"size", 1.2}, {"intensity", 9}, {"color", {0.6, 0.8, 1}}},
                   {{"translation", {-0.6, 2.6, 1.2}}, {"rotation", {-0.6, 0, 0, 0.8}}});
  scene.environment({{"color", {0.2, 0.3, 0.4}}});
  scene.ambient(Color(0.03F, 0.03F, 0.04F));
  scene.look_at(Point(0.2F, 2.6F, 4), Point(0, 0.7F, 0.2F), 44, width, height);
  return with_integrator(scene.state(), Integrator::path);
}

/// Edits of values; along trees that stay as they are.
struct ColorEdit {
  const char* name;
  FieldMask fields;
  std::function<void(Material&)> apply;
};
std::vector<ColorEdit> color_edits() {
  const FieldMask base = mask_of(Field::base_color);
  return {
      {"base colour", base, [](Material& m) { m.base_color = Rgba(0.7F, 0.2F, 0.9F, m.base_color.a); }},
      {"black", base, [](Material& m) { m.base_color = Rgba(0, 0, 0, m.base_color.a); }},
      {"alpha", base, [](Material& m) { m.base_color.a *= 0.9F; }},
      {"roughness", mask_of(Field::roughness), [](Material& m) { m.roughness *= 1.0F - 1.0F / 64; }},
      {"metallic", mask_of(Field::metallic), [](Material& m) { m.metallic *= 1.0F - 1.0F / 256; }},
      {"glass", mask_of(Field::transmission) | mask_of(Field::attenuation_color) | mask_of(Field::attenuation_distance),
       [](Material& m) {
         m.transmission *= 0.9F;
         m.attenuation_color = m.attenuation_color * 0.5F;
         m.attenuation_distance *= 0.75F;
       }},
      {"proportions", mask_of(Field::transparency) | mask_of(Field::refraction) | mask_of(Field::phong_diffuse),
       [](Material& m) {
         m.transparency *= 0.75F;
         m.refraction *= 0.5F;
         m.phong_diffuse = m.phong_diffuse * 0.5F;
       }},
      {"several", base | mask_of(Field::sheen_color) | mask_of(Field::clearcoat), [](Material& m) {
         m.base_color.r *= 0.5F;
         m.sheen_color = m.sheen_color * 0.5F;
         m.clearcoat *= 0.75F;
       }}};
}

/// All lights of a document in one sum.
void share_sums(Scene& scene) {
  for (const LightId light : scene.light_order)
    if (traits_of(scene.light(light).kind).in_document) scene.lights[light.index()].sum = "others";
}

struct TermCase {
  const char* name;
  SceneState (*scene)(std::uint32_t width, std::uint32_t height);
  bool shares = false;
};
const TermCase kTermCases[] = {{"lights", lights_scene},
                               {"lights_in_one_sum", lights_scene, true},
                               {"spheres", spheres_scene},
                               {"cards", cards_scene},
                               {"study", study_scene},
                               {"leaves", leaves_scene},
                               {"leaves_in_one_sum", leaves_scene, true}};

/// Is it on a tree's way, or on that of its light?
bool is_met(const Trees& trees, const Scene& scene, MaterialId material) {
  const auto has = [&](const auto& place) {
    return !place.object.is_none() && scene.object(place.object).material == material;
  };
  return std::ranges::any_of(trees.block.nodes, has) || std::ranges::any_of(trees.block.filters, has);
}

class ExchangedTerms : public testing::TestWithParam<TermCase> {};

TEST_P(ExchangedTerms, are_those_of_shading_twice) {
  const SceneState state = with_integrator(GetParam().scene(24, 18), Integrator::path);
  const Trees trees(state, deep_view());
  Scene before = state.scene();
  if (GetParam().shares) share_sums(before);
  const ColorScene before_rays(trees.rays, before);
  const TileSums before_sums = shaded(trees, before_rays);
  for (std::uint32_t index = 0; index < before.materials.size(); ++index) {
    std::size_t changed = 0;
    for (const ColorEdit& edit : color_edits()) {
      SCOPED_TRACE("material " + std::to_string(index) + ", " + edit.name);
      Scene after = before;
      edit.apply(after.materials[index]);
      const TileSums after_sums = shaded(trees, ColorScene(trees.rays, after));
      ParameterSet parameters;
      parameters.materials.emplace_back(MaterialId(index), edit.fields);
      TilePrograms programs(before_rays);
      PathShader shader(before_rays, programs.path(), programs.places());
      KeptTerms kept;
      shader.keep(trees.block, trees.view.samples, parameters, kept);
      TermMemory memory;
      TileSums sums = before_sums;
      exchange_terms(kept, before, after, programs.places(), memory, sums);
      EXPECT_EQ(sums, after_sums);
      exchange_terms(kept, after, before, programs.places(), memory, sums);
      EXPECT_EQ(sums, before_sums) << "and back";
      changed += before_sums == after_sums ? 0 : 1;
    }
    EXPECT_EQ(changed > 0, is_met(trees, before, MaterialId(index))) << "material " << index;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExchangedTerms, testing::ValuesIn(kTermCases),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(LeavesScene, has_every_place_where_factors_come_together) {
  const SceneState state = leaves_scene(24, 18);
  const Trees trees(state, deep_view());
  std::size_t nested = 0, stopped = 0, passed = 0, opened = 0, inside = 0;
  for (const LightLink& link : trees.block.lights)
    if (link.state == ShadowState::filtered && link.filters > 1) ++nested;
  for (const FilterNode& filter : trees.block.filters) inside += filter.length_inside > 0 ? 1 : 0;
  for (const RayNode& node : trees.block.nodes) {
    stopped += node.coverage.way == CoverageChoice::Way::stops ? 1 : 0;
    passed += node.coverage.way == CoverageChoice::Way::passes ? 1 : 0;
    opened += node.ray.branch == Branch::transparency && node.ray.path.from.is_none() ? 1 : 0;
  }
  EXPECT_GT(nested, 50U) << "tints behind tints";
  EXPECT_GT(inside, 10U) << "tints of volumes";
  EXPECT_GT(stopped, 20U) << "chosen by buckets of coverage";
  EXPECT_GT(passed, 20U);
  EXPECT_GT(opened, 100U) << "coverage of what is behind coverage";
}

/// Of lights whose terms vertices give, and of the sky.
struct VertexLights {
  VertexLights(const ColorScene& scene, const SumPlaces& places) : sums(places.count, 0) {
    sums[places.sky] = 1;
    for (std::size_t place = 0; place < scene.light_order().size(); ++place) {
      const Light& light = scene.scene().light(scene.light_order()[place]);
      const bool shows = light.visible && scene.light(place).shape;
      lights.push_back(light.kind != LightKind::emission && !shows ? 1 : 0);
    }
  }
  std::vector<std::uint8_t> sums, lights;
};

/// Terms of a light at a batch's vertices, for what stands between them in the trees.
std::vector<LitTerm> lit_terms(const Trees& trees, const TileVertices::Batch& batch,
                               std::span<const std::uint32_t> node_of_hit, std::uint32_t place) {
  const RayLight& light = trees.rays.light(place);
  std::vector<LitTerm> terms;
  for (std::size_t k = 0; k < batch.vertices.size(); ++k) {
    const LitVertex& vertex = batch.vertices[k];
    const LightLink& link = trees.block.lights[trees.block.nodes[node_of_hit[vertex.hit]].first_light + place];
    if (!reaches(link.state)) continue;
    RayNode node(kNoNode, 0, {});
    vertex.restore(node);
    VertexLobes lobes;
    if (vertex.has_lobes())
      lobes = vertex.other_lobes != kNoNode ? batch.other_lobes[vertex.other_lobes] : vertex.lobes.restored();
    const bool has_lobes = vertex.has_lobes() && light.is_soft();
    auto term = light_term(
        trees.rays,
        {node, has_lobes ? &lobes : nullptr, std::span(trees.block.filters).subspan(link.first, link.filters), nullptr},
        place);
    if (!term) continue;
    term->columns = batch.values.data() + k * batch.columns;
    terms.push_back({*term, vertex.weight, vertex.scale, vertex.pixel, link.first, link.filters});
  }
  return terms;
}

class KeptVertices : public testing::TestWithParam<TestScene> {};

TEST_P(KeptVertices, are_given_the_terms_of_their_trees) {
  const SceneState state = with_integrator(test_scene(GetParam(), 24, 18), Integrator::path);
  const Trees trees(state, deep_view());
  TilePrograms programs(trees.rays);
  const SumPlaces& places = programs.places();
  PathShader shader(trees.rays, programs.path(), places);
  TileSums all(places.count, trees.rect.pixels()), expected = all, kept = all, found = all;
  shader.shade(trees.block, trees.view.samples, TermSign::add, all);
  const std::vector<Color> weights(shader.weights().begin(), shader.weights().end());
  const VertexLights asked(trees.rays, places);
  const PathShader::Wanted wanted{asked.sums, asked.lights, {}, weights};
  shader.shade(trees.block, trees.view.samples, TermSign::add, expected, wanted);
  TileVertices vertices;
  shader.shade_keeping(trees.block, trees.view.samples, kept, wanted, vertices);
  EXPECT_EQ(kept, expected);

  std::vector<std::uint32_t> node_of_hit;
  for (std::uint32_t i = 0; i < trees.block.nodes.size(); ++i)
    if (!trees.block.nodes[i].object.is_none()) node_of_hit.push_back(i);
  ASSERT_EQ(vertices.hits, node_of_hit.size());
  VertexShader vertex_shader(trees.rays, programs.path(), places);
  std::size_t lit = 0;
  for (std::uint32_t place = 0; place < asked.lights.size(); ++place) {
    if (asked.lights[place] == 0) continue;
    for (const TileVertices::Batch& batch : vertices.batches) {
      const std::vector<LitTerm> terms = lit_terms(trees, batch, node_of_hit, place);
      vertex_shader.add_lit(batch, trees.block, terms, found);
      lit += terms.size();
    }
  }
  vertex_shader.add_met(vertices.leaving, true, {asked.sums, asked.lights}, found);
  vertex_shader.add_met(vertices.crossing, false, {asked.sums, asked.lights}, found);
  EXPECT_EQ(found, expected);
  EXPECT_GT(lit, trees.roots.size() / 4) << "there is something to see";
}

INSTANTIATE_TEST_SUITE_P(Scenes, KeptVertices, testing::ValuesIn(kScenes));

}  // namespace
}  // namespace relook
