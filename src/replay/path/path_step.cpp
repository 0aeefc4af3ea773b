#include "replay/path/path_step.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "image/image_pieces.h"
#include "replay/path/path_tile.h"
#include "replay/path/relight_tile.h"
#include "trace/box_range.h"
#include "trace/tree/path_cursor.h"

namespace relook {
namespace {

/// Does light of one of these places of the light order come to a hit?
bool sees_any(std::span<const std::uint32_t> words, const PathLayout& layout, std::span<const std::uint32_t> places) {
  for (PathCursor cursor(words, layout); !cursor.at_end();) {
    const PathNode node = cursor.next();
    if (node.is_miss()) continue;
    for (const std::uint32_t place : places) {
      const ShadowState state = shadow_state(node.lights, place);
      if (reaches(state)) return true;
    }
  }
  return false;
}

/// Which paths an edit may reach.
class PathSelection {
 public:
  PathSelection(const StoredImage& stored, const PathChange& change, const Scene& scene)
      : stored_(stored), change_(change), scene_(scene) {}

  void select(PathPass& pass) const {
    const std::size_t paths = stored_.image().paths.size();
    pass.updates_all = change_.step.touches_segments() || change_.step.rays.lights_changed;
    pass.ray_use = ray_use();
    pass.update_path.assign(paths, pass.updates_all ? 1 : 0);
    pass.shade_path.assign(paths, 0);
    const std::vector<std::uint8_t>& flags = change_.step.rays.objects;
    pass.named_path.assign(paths, 0);
    for (std::uint32_t object = 0; object < flags.size(); ++object)
      if (flags[object] != 0) flag(ObjectId(object), pass.named_path);
    for (std::size_t path = 0; path < paths; ++path) pass.update_path[path] |= pass.named_path[path];
    for (const ObjectId object : change_.step.colors.reassigned) flag(object, pass.shade_path);
    select_relit(pass);
    if (change_.shaded.empty()) return;
    for (std::uint32_t object = 0; object < scene_.objects.size(); ++object)
      if (std::ranges::find(change_.shaded, scene_.objects[object].material) != change_.shaded.end())
        flag(ObjectId(object), pass.shade_path);
  }

 private:
  [[nodiscard]] RayUse ray_use() const {
    const StepChange& step = change_.step;
    if (step.touches_rays() && !step.rays.lights_changed) return change_.relights() ? RayUse::none : RayUse::tests;
    const bool only_lights = change_.relights() && step.rays.only_lights() && !change_.any_taken() &&
                             !gives_emission() && change_.shaded.empty() && step.colors.reassigned.empty();
    if (only_lights) return RayUse::lights;
    return step.touches_rays() ? RayUse::none : RayUse::colors;
  }
  /// What shines at a hit has a column of its own there.
  [[nodiscard]] bool gives_emission() const {
    for (std::size_t place = 0; place < change_.given.size(); ++place)
      if (change_.given[place] != 0 && scene_.light(scene_.light_order[place]).kind == LightKind::emission) return true;
    return false;
  }

  void flag(ObjectId object, std::vector<std::uint8_t>& paths) const {
    for (const PathId path : stored_.index().paths_of(object)) paths[path.index()] = 1;
  }

  /// Of lamps without size that stay where they are and change in a sum that they share.
  void select_relit(PathPass& pass) const {
    if (change_.step.rays.lights_changed || change_.any_afresh() || !change_.any_given()) return;
    std::vector<std::uint32_t> places;
    for (std::uint32_t place = 0; place < change_.given.size(); ++place) {
      if (change_.given[place] == 0) continue;
      if (pass.grow_after.scene.light(place).is_soft()) return;  // rays may meet it anywhere
      places.push_back(place);
    }
    const PathTable& paths = stored_.image().paths;
    const PathLayout layout{change_.given.size(), 0};
    pass.relight_path.assign(paths.size(), 0);
    for (std::uint32_t path = 0; path < paths.size(); ++path)
      pass.relight_path[path] = sees_any(paths.words(PathId(path)), layout, places) ? 1 : 0;
  }

  const StoredImage& stored_;
  const PathChange& change_;
  const Scene& scene_;
};

void count(const PathTileResult& tile, Counters& counters) {
  counters.samples_affected += tile.samples;
  counters.color_trees_evaluated += tile.samples;
  counters.color_trees_reused += tile.reused;
  counters.ray_tests += tile.counters.ray_tests;
  counters.culled += tile.counters.culled;
  counters.ray_tests_culled += tile.counters.culled.sum();
  counters.ray_updates += tile.counters.ray_updates;
  counters.shadow_updates += tile.counters.shadow_updates;
  counters.object_rays += tile.counters.object_rays;
}

constexpr std::size_t kMostKeptLights = 0x7000;  // whose terms at a node, met ones too, KeptTerms can count

/// The boxes of what a step moves or hides, and of where that was.
SegmentSelection segment_selection(const ChangeBoxes& boxes) {
  const auto of = [](const BoxSet& set) { return SelectionBoxes{set.all, set.parts}; };
  return {{of(boxes.moved), of(boxes.shadows_after), of(boxes.shadows_before)}, boxes.condition};
}

/// A grid in which the segments of the scene can be told from such a selection.
SegmentGrid segment_grid(const RayScene& scene, const SegmentSelection& selection) {
  Box all, moved;
  for (std::uint32_t object = 0; object < scene.size(); ++object)
    if (scene.object(ObjectId(object)).alive) all.extendBy(world_bounds(scene.object(ObjectId(object))));
  for (const SelectionBoxes& boxes : selection.of) moved.extendBy(boxes.all);
  if (moved.isEmpty()) return {};
  all.extendBy(moved);
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max(largest, std::max(std::fabs(all.min[axis]), std::fabs(all.max[axis])));
  const float margin = 0x1p-16F * largest * selection.condition;  // what tests add for rays that set out that far away
  const Point around(margin, margin, margin);
  return {all, Box(moved.min - around, moved.max + around)};
}

/// Brings trees and sums up to date, tile by tile.
class PathUpdate {
 public:
  PathUpdate(ReplayParts& parts, PathChange& change) : parts_(parts), stored_(parts.stored), change_(change) {}

  /// By tile: have its sums changed?
  [[nodiscard]] std::vector<std::uint8_t> run(StepResult& result) {
    const ColorScene before(change_.rays_before, *change_.scene_before);
    const TilePrograms programs_before(before), programs_after(parts_.rays);
    const Tracer::TopLevel* level = nullptr;
    SegmentSelection selection;
    if (change_.step.touches_rays() || may_trace_tiles()) {
      level = &parts_.current_level({});
      parts_.residency.require_floor();
      build_selection(change_.step, parts_.rays, {}, parts_.level->tracer());
      const ChangeBoxes boxes = boxes_of(change_.step, parts_.rays);
      change_.step.rays.bounds = {boxes.moved.all, boxes.shadows_before.all, boxes.shadows_after.all, boxes.condition};
      selection = segment_selection(boxes);
    }
    const GrowScene grow_before = grow_scene(before, nullptr, stored_.image().view, 0);
    const GrowScene grow_after = grow_scene(parts_.rays, level, stored_.image().view, 0, &parts_.objects);
    Pool<PathShader> shaders_before, shaders_after;
    Pool<VertexShader> vertex_shaders;
    Pool<TermMemory> term_memory;
    PathPass pass{change_,    stored_.image(), programs_before, programs_after, grow_before,
                  grow_after, shaders_before,  shaders_after,   vertex_shaders, term_memory};
    PathSelection(stored_, change_, parts_.state.scene()).select(pass);
    if (change_.step.touches_segments() && !change_.step.rays.lights_changed) {
      pass.selection = std::move(selection);
      if (may_write_segments(pass)) pass.segment_grid = segment_grid(parts_.rays, pass.selection);
    }
    pass.uses_vertices = may_use_vertices(pass);
    if (pass.ray_use == RayUse::colors && !change_.relights()) pass.term_parameters = term_parameters();
    std::vector<PathTileResult> results(stored_.image().trees.size());
    parallel_for(results.size(), [&](std::size_t tile) { update(pass, tile, results[tile]); });
    std::vector<NewSamples> fresh;
    std::vector<std::uint8_t> changed;
    for (PathTileResult& tile : results) {
      changed.push_back(tile.has_changed ? 1 : 0);
      count(tile, result.counters);
      fresh.push_back(std::move(tile.fresh));
    }
    if (change_.step.touches_rays()) stored_.keep_paths(fresh, grow_after, !change_.step.rays.keeps_places);
    return changed;
  }

 private:
  /// Tiles whose hits are gone, or go under a limit, are traced as a whole.
  [[nodiscard]] bool may_trace_tiles() const {
    return parts_.residency.is_limited() || !std::ranges::all_of(stored_.image().trees, has_hits);
  }

  /// Are there tiles, or may there be some, whose segments are not known, or not as the step wants them?
  [[nodiscard]] bool may_write_segments(const PathPass& pass) const {
    if (parts_.residency.is_watched() || pass.ray_use != RayUse::tests) return true;
    for (std::size_t tile = 0; tile < stored_.image().trees.size(); ++tile)
      if (stored_.kept_segments(tile).empty() || !stored_.kept_segments(tile).can_tell(pass.selection)) return true;
    return false;
  }
  /// By sample: may what moves touch its tree? Empty: not known. Requires: PieceKind::kept_segments is leased.
  [[nodiscard]] std::vector<std::uint8_t> find_touched(const PathPass& pass, std::size_t tile) const {
    const TileSegments& segments = stored_.kept_segments(tile);
    std::vector<std::uint8_t> touched;
    if (segments.empty() || pass.ray_use != RayUse::tests || !change_.step.touches_segments() ||
        !segments.can_tell(pass.selection))
      return touched;
    touched.resize(segments.samples());
    segments.find_touched(pass.selection, touched);
    return touched;
  }

  /// Of an edit of colours that leaves expressions their shape; else none.
  [[nodiscard]] std::optional<ParameterSet> term_parameters() const {
    const ColorChange& colors = change_.step.colors;
    if (!is_compressible(colors) || !colors.restructured.empty() || change_.shaded.empty() ||
        parts_.rays.light_order().size() > kMostKeptLights)
      return std::nullopt;
    ParameterSet parameters;
    parameters.materials = colors.parameters.materials;
    return parameters;
  }
  /// Is a tile traced as a whole in less time than its trees are updated? Trees of changed objects are expanded as they
  /// were, shaded, grown anew and shaded again, about twice the work of tracing them; the others are tested, unless
  /// they are known to be left alone.
  [[nodiscard]] bool is_sooner_traced(const PathPass& pass, std::size_t tile,
                                      std::span<const std::uint8_t> touched) const {
    if (pass.grow_after.level == nullptr || change_.step.rays.only_lights()) return false;
    const double kUpdated = 2.2, kTested = stored_.kept_rays(tile).empty() ? 0.6 : 0.4;  // over the time to trace
    const Image& image = stored_.image();
    const std::vector<PathId>& paths = image.trees[tile].paths;
    double all = 0, updated = 0, tested = 0;
    for (std::size_t sample = 0; sample < paths.size(); ++sample) {
      const auto work = static_cast<double>(image.paths.words(paths[sample]).size());
      all += work;
      if (pass.named_path[paths[sample].index()] != 0)
        updated += work;
      else if (touched.empty() || touched[sample] != 0)
        tested += work;
    }
    return updated * kUpdated + tested * kTested > all;
  }

  [[nodiscard]] static bool may_recolor(const PathPass& pass, const TileTerms& terms) {
    return pass.term_parameters && !terms.empty() && terms.parameters.contains(*pass.term_parameters);
  }

  /// Is a tile without kept vertices to keep those of the step?
  [[nodiscard]] bool makes_vertices(const PathPass& pass, std::size_t tile) const {
    constexpr std::size_t kBytesOfHit = 256;  // about
    const std::size_t bytes = stored_.image().trees[tile].hits.size() * kBytesOfHit;
    return pass.uses_vertices && parts_.residency.is_worth_room(PieceKind::kept_vertices, tile, bytes);
  }

  void update(const PathPass& pass, std::size_t tile, PathTileResult& result) {
    std::optional<Residency::Lease> trees;
    {
      const auto segments = parts_.residency.use(PieceKind::kept_segments, tile);
      std::vector<std::uint8_t> touched = find_touched(pass, tile);
      if (auto left = leave_path_tile(pass, tile, stored_.kept_segments(tile), touched)) {
        result = std::move(*left);
        return;
      }
      trees.emplace(parts_.residency.use(PieceKind::ray_trees, tile));
      const auto sums = parts_.residency.use(PieceKind::light_sums, tile);
      const auto rays = parts_.residency.use(PieceKind::kept_rays, tile);
      const auto terms = parts_.residency.use(PieceKind::kept_terms, tile);
      const auto vertices = parts_.residency.use(PieceKind::kept_vertices, tile);
      const TileVertices* kept = stored_.kept_vertices(tile);
      const PackedSums& sums_before = stored_.image().light_sums[tile];
      if (may_recolor(pass, stored_.kept_terms(tile)))
        result = recolor_path_tile(pass, tile, sums_before, stored_.kept_terms(tile));
      else if (pass.uses_vertices && kept != nullptr && has_hits(stored_.image().trees[tile]))
        result = relight_path_tile(pass, tile, sums_before, *kept);
      else if (has_hits(stored_.image().trees[tile]) && !is_sooner_traced(pass, tile, touched))
        result = update_path_tile(pass, tile,
                                  {sums_before, stored_.kept_rays(tile), stored_.kept_segments(tile),
                                   std::move(touched), makes_vertices(pass, tile)});
      else
        result = trace_path_tile(pass, tile);
    }
    if (result.vertices || !result.keeps_vertices)
      stored_.keep_vertices(tile, std::move(result.vertices).value_or(TileVertices()));
    result.vertices.reset();
    if (result.terms) stored_.keep_terms(tile, std::move(*result.terms));
    if (result.has_other_weights) stored_.forget_weights(tile);
    result.terms.reset();
    if (result.rays) stored_.keep_rays(tile, std::move(*result.rays));
    result.rays.reset();
    if (result.segments) stored_.keep_segments(tile, std::move(*result.segments));
    result.segments.reset();
    stored_.keep_hits(result.fresh);
    if (result.has_changed) stored_.keep_sums(tile, std::move(result.sums));
    result.sums = {};
  }

  ReplayParts& parts_;
  StoredImage& stored_;
  PathChange& change_;
};

/// `tiles`: by tile, whether its pixels may be others.
void refresh_pixels(StoredImage& stored, std::span<const std::uint8_t> tiles, std::span<const LightSum> sums,
                    StepResult& result) {
  const std::vector<LightColor> colors = colors_of(sums);
  std::vector<TileMask> changed(stored.image().trees.size());
  parallel_for(changed.size(), [&](std::size_t tile) {
    if (tiles[tile] != 0) stored.refresh_from_sums(tile, colors, changed[tile]);
  });
  for (std::size_t tile = 0; tile < changed.size(); ++tile) result.changed_pixels.add(tile, changed[tile]);
}

}  // namespace

StepResult path_step(ReplayParts& parts, const SceneEdit& edit) {
  StepResult result;
  StopWatch watch;
  parts.residency.begin_change();
  const RayScene rays_before = parts.rays;
  const std::vector<LightSum> sums_before = light_sums(parts.state.scene());
  auto [delta, classification] = edit(parts.state);
  const Scene& scene = parts.state.scene();
  result.classification = std::move(classification);
  if (parts.stored.regions().options().atoms > 0) parts.stored.extend_atoms(parts.atoms());
  result.counters.samples_total = parts.stored.samples();
  parts.rays = ColorScene(rays_before.after(scene, delta), scene);
  PathChange change = find_path_change(rays_before, parts.stored.lights(), sums_before, scene, parts.rays, delta);
  const std::vector<ObjectId> changed = selection_of(change.step);
  if (parts.level) parts.level->note_changed(changed);
  parts.objects.go_on(parts.rays, changed);
  watch.lap(result.seconds.classify);
  std::vector<std::uint8_t> tiles(parts.image().trees.size(), 0);
  if (change.touches_samples()) tiles = PathUpdate(parts, change).run(result);
  watch.lap(change.step.touches_rays() ? result.seconds.update : result.seconds.evaluate);
  if (change.recolored) std::ranges::fill(tiles, std::uint8_t{1});
  refresh_pixels(parts.stored, tiles, change.sums, result);
  watch.lap(result.seconds.evaluate);
  return result;
}

void keep_path_terms(ReplayParts& parts, const ParameterSet& parameters) {
  const Scene& scene = parts.state.scene();
  PathChange change = find_path_change(parts.rays, parts.stored.lights(), light_sums(scene), scene, parts.rays, {});
  change.scene_before = std::make_shared<const Scene>(scene);
  for (const auto& [material, fields] : parameters.materials) {
    if ((fields & ~kMappingMask) == 0) continue;  // what is mapped otherwise is shaded anew
    change.step.colors.parameters.materials.emplace_back(material, fields & ~kMappingMask);
    change.shaded.push_back(material);
  }
  if (change.shaded.empty()) return;
  StepResult unchanged;
  static_cast<void>(PathUpdate(parts, change).run(unchanged));
}

}  // namespace relook
