#include "edit/effect/effect.h"

#include "edit/effect/lobe_effect.h"

namespace relook {

ChangeClass class_of(const ObjectEffect& effect) {
  if (effect.moved) return ChangeClass::geometric;
  return effect.respawns ? ChangeClass::optical : ChangeClass::color;
}

ObjectEffect effect_of(const Material& before, const SurfaceOptics& optics_before, const Material& after,
                       const SurfaceOptics& optics_after, const Mesh& mesh, Integrator integrator,
                       std::span<const MaterialRow> rows) {
  const auto differ = [&](MaterialRow::Trait trait) { return differs(trait, before, after, rows); };
  ObjectEffect effect;
  effect.moved = optics_before.cut_out != optics_after.cut_out || optics_before.culls_back != optics_after.culls_back ||
                 (optics_after.cut_out && differ(MaterialRow::cuts));
  effect.shadows = effect.moved || optics_before.passes_light != optics_after.passes_light;
  effect.respawns = optics_before != optics_after || (optics_after.spawns() && differ(MaterialRow::bends)) ||
                    (optics_after.coat_reflects && differ(MaterialRow::bends_coat)) ||
                    (integrator == Integrator::path &&
                     (turns_lobes(before, after, rows) || turns_coverage(before, after, mesh)));
  return effect;
}

ObjectEffect effect_of(const Object& before, const Object& after) {
  Object placed = before;
  placed.material = after.material;
  const bool moved = placed != after;
  return {.moved = moved, .shadows = moved};
}

LightEffect effect_of(const Light& before, const Light& after) {
  LightEffect effect;
  effect.exists_otherwise = before.alive != after.alive;
  effect.moved = before.kind != after.kind || before.position != after.position || before.direction != after.direction;
  effect.moved = effect.moved || before.radius != after.radius || before.angle != after.angle ||
                 before.right != after.right || before.up != after.up || before.visible != after.visible ||
                 before.rate != after.rate || before.emission != after.emission || before.image != after.image ||
                 before.rotation != after.rotation;
  effect.reshaded = before.range != after.range || before.inner_cone != after.inner_cone ||
                    before.outer_cone != after.outer_cone || before.excluded != after.excluded ||
                    before.sum != after.sum;
  effect.recolored = before.color != after.color || before.intensity != after.intensity || effect.reshaded;
  return effect;
}

ChangeClass class_of(const LightEffect& effect) {
  return effect.exists_otherwise || effect.moved ? ChangeClass::geometric : ChangeClass::color;
}

}  // namespace relook
