#include "report/pixel_history.h"

#include <cstring>
#include <set>

#include "image/sampling.h"
#include "image/tile_light.h"
#include "replay/change.h"
#include "report/pixel_facts.h"
#include "trace/scene_level.h"

namespace relook {
namespace {

const std::string* find(const std::map<ObjectId, std::string>& names, ObjectId id) {
  const auto found = names.find(id);
  return found == names.end() ? nullptr : &found->second;
}

/// What tells why a pixel changed: the trees before and after an edit, and the selection's levels.
struct Comparison {
  const Scene& scene;  // after the edit
  const PixelFacts &before, &after;
  const RayChange& rays;

  /// Objects that changed and meet a segment whose shadow is another now, with a sentence each.
  [[nodiscard]] std::map<ObjectId, std::string> shadow_casters() const {
    std::map<ObjectId, std::string> casters;
    for (const auto& [place, segment] : before.segments) {
      const auto now = after.segments.find(place);
      const bool is_same =
          now != after.segments.end() && now->second.state == segment.state && now->second.filters == segment.filters;
      if (!is_same) note_blockers(rays.shadows_before, segment, casters);
    }
    for (const auto& [place, segment] : after.segments) {
      const auto then = before.segments.find(place);
      const bool is_same = then != before.segments.end() && then->second.state == segment.state &&
                           then->second.filters == segment.filters;
      if (!is_same) note_blockers(rays.shadows_after, segment, casters);
    }
    return casters;
  }

  static void note_blockers(const Tracer::TopLevel& level, const SegmentFacts& segment,
                            std::map<ObjectId, std::string>& casters) {
    if (level.empty() || segment.state == ShadowState::facing_away) return;
    std::vector<Crossing> crossings;
    Tracer::blockers(level, {segment.segment.origin, segment.segment.direction, segment.segment.t_max}, crossings);
    for (const Crossing& crossing : crossings) casters.try_emplace(crossing.object, "shadow from " + segment.name);
  }

  [[nodiscard]] std::vector<std::string> causes(const SceneDelta& delta) const {
    std::vector<std::string> causes;
    const std::map<ObjectId, std::string> casters = shadow_casters();
    for (const SceneDelta::MaterialChange& change : delta.materials) add_material(change.id, casters, causes);
    for (const SceneDelta::ObjectChange& change : delta.objects) {
      const std::string name = "node " + object_name(scene.object(change.id)) + ": ";
      const std::string* how = nullptr;
      for (const auto* names : {&before.hits, &after.hits, &before.filters, &after.filters, &casters})
        if (how == nullptr) how = find(*names, change.id);
      if (how != nullptr) causes.push_back(name + *how);
      if (how == nullptr) add_emission_of(change, name, causes);
    }
    for (const SceneDelta::LightChange& change : delta.lights) add_light(change, causes);
    if (delta.ambient_before && !(before.hits.empty() && after.hits.empty()))
      causes.push_back("ambient light: on " + (before.hits.empty() ? after : before).hits.begin()->second);
    if (delta.environment_before && !(before.environment.empty() && after.environment.empty()))
      causes.push_back("environment: " + (before.environment.empty() ? after : before).environment);
    if (causes.empty()) add_met_lights(delta, causes);
    return causes;
  }

  static std::string changed_name(const SceneDelta::LightChange& change, const Light& light) {
    return "light " + light_name(light.alive || !light.light.empty() ? light : change.before);
  }
  void add_light(const SceneDelta::LightChange& change, std::vector<std::string>& causes) const {
    for (const PixelFacts* facts : {&before, &after}) {
      const auto reached = facts->lights.find(change.id);
      if (reached == facts->lights.end()) continue;
      causes.push_back(changed_name(change, scene.light(change.id)) + ": on " + reached->second);
      return;
    }
  }
  /// Of an object that emits: what moves is its share in the light of its material.
  void add_emission_of(const SceneDelta::ObjectChange& change, const std::string& name,
                       std::vector<std::string>& causes) const {
    const MaterialId now = scene.object(change.id).material;
    for (const PixelFacts* facts : {&before, &after})
      for (const auto& [id, route] : facts->lights) {
        const Light& light = scene.light(id);
        if (light.kind != LightKind::emission || (light.material != now && light.material != change.before.material))
          continue;
        causes.push_back(name + "light " + light_name(light) + " on " + route);
        return;
      }
  }
  /// What no sample brings: a light that rays have crossed, or do now.
  void add_met_lights(const SceneDelta& delta, std::vector<std::string>& causes) const {
    for (const SceneDelta::LightChange& change : delta.lights)
      causes.push_back(changed_name(change, scene.light(change.id)) + ": met by rays");
    if (!causes.empty()) return;
    for (const SceneDelta::ObjectChange& change : delta.objects)
      causes.push_back("node " + object_name(scene.object(change.id)) + ": its light, met by rays");
  }

  void add_material(MaterialId id, const std::map<ObjectId, std::string>& casters,
                    std::vector<std::string>& causes) const {
    const std::string& given = scene.material(id).name;
    const std::string name = "material " + (given.empty() ? "(default)" : given) + ": ";
    std::set<std::string> known;
    for (const PixelFacts* facts : {&before, &after})
      if (const auto uses = facts->materials.find(id); uses != facts->materials.end())
        known.insert(uses->second.begin(), uses->second.end());
    for (const auto& [object, how] : casters)
      if (scene.object(object).material == id) known.insert(how + " of " + object_name(scene.object(object)));
    for (const std::string& how : known) causes.push_back(name + how);
  }
};

}  // namespace

struct PixelHistory::Impl {
  SceneState state;
  ViewOptions view;
  TileRect pixel;
  ColorScene rays;
  SceneLevel level{true};  // asked for blockers
  Rgba color{0, 0, 0, 0};
  PixelFacts facts;

  Impl(SceneState s, const ViewOptions& v, std::uint32_t x, std::uint32_t y)
      : state(std::move(s)), view(v), pixel{x, y, x + 1, y + 1}, rays(state.scene()) {
    view.shadow_bits = 0;  // colours do not depend on counters
    trace();
  }

  void trace() {
    const GrowScene grow = grow_scene(rays, &level.current(rays), view, view.shadow_bits);
    const PrimaryRays primary(state.scene().camera, view);
    std::vector<SpawnedRay> primaries;
    primary.append(pixel, 0, view.samples, primaries);
    TreeBlock block;
    std::vector<std::uint32_t> roots;
    GrowCounters counters;
    trace_trees(grow, primaries, 0, block, roots, counters);
    const TilePrograms programs(rays);
    TileShading shading(programs, view.samples);
    TileLight light;
    shading.begin(pixel, light);
    shading.add(block, roots, 0, light);
    color = programs.pixel(light, 0, view.samples);
    facts = pixel_facts(state.scene(), rays, block, roots);
  }

  PixelStep step(const SceneEdit& edit) {
    PixelStep result;
    const std::vector<LightId> old_lights = state.scene().light_order;
    auto [delta, classification] = edit(state);
    result.classification = std::move(classification);
    StepChange change = find_change(rays, state.scene(), delta, old_lights);
    rays = ColorScene(rays.after(state.scene(), delta), state.scene());
    level.note_changed(selection_of(change));
    result.before = color;
    const PixelFacts before = std::move(facts);
    trace();
    result.after = color;
    result.is_changed = std::memcmp(&result.before, &result.after, sizeof(Rgba)) != 0;
    if (!result.is_changed) return result;
    build_selection(change, rays, {}, level.tracer());
    result.causes = Comparison{state.scene(), before, facts, change.rays}.causes(delta);
    return result;
  }
};

PixelHistory::PixelHistory(SceneState state, const ViewOptions& view, std::uint32_t x, std::uint32_t y)
    : impl_(std::make_unique<Impl>(std::move(state), view, x, y)) {}
PixelHistory::~PixelHistory() = default;

Rgba PixelHistory::color() const { return impl_->color; }
const std::vector<std::string>& PixelHistory::paths() const { return impl_->facts.lines; }
PixelStep PixelHistory::step(const SceneEdit& edit) { return impl_->step(edit); }

}  // namespace relook
