// What a change of one thing in the scene does, from its values before and after alone. Replay carries it out, and the
// class that a report states (Table 1 of the paper) follows from it.
#pragma once
#include "edit/apply.h"
#include "scene/material_fields.h"
#include "scene/scene.h"
#include "scene/surface_optics.h"

namespace relook {

/// What a change of one object does.
struct ObjectEffect {
  bool moved = false;     // hits on the object are not valid any more; it may be met elsewhere
  bool shadows = false;   // it blocks or filters light differently (moved objects too)
  bool respawns = false;  // its hits stay, but other rays may leave from them
};
/// Geometric where it is moved, optical where rays leave otherwise (whatever filters light otherwise spawns otherwise).
[[nodiscard]] ChangeClass class_of(const ObjectEffect& effect);

/// The effect of another material, or of other values of its material, on an object whose mesh makes these optics of
/// them. Under Integrator::path `respawns` is an upper bound (lobe_effect.h).
[[nodiscard]] ObjectEffect effect_of(const Material& before, const SurfaceOptics& optics_before, const Material& after,
                                     const SurfaceOptics& optics_after, const Mesh& mesh,
                                     Integrator integrator = Integrator::whitted,
                                     std::span<const MaterialRow> rows = material_rows());
/// The effect of all else that has changed about an object: everything but its material.
[[nodiscard]] ObjectEffect effect_of(const Object& before, const Object& after);

struct LightEffect {
  bool exists_otherwise = false;  // it appears or disappears
  bool moved = false;             // its light comes from elsewhere, or by other samples
  bool recolored = false;         // a colour parameter is another one
  bool reshaded = false;          // and not only colour and intensity, which multiply the whole of its light
};
[[nodiscard]] LightEffect effect_of(const Light& before, const Light& after);
[[nodiscard]] ChangeClass class_of(const LightEffect& effect);

}  // namespace relook
