#include "replay/chosen_parameters.h"

#include "base/error.h"
#include "edit/effect/trial_edits.h"
#include "replay/change.h"
#include "trace/ray_scene.h"

namespace relook {

ParameterSet parameters_at(SceneState& state, const std::string& pointer) {
  constexpr std::string_view kFlag = "--params";
  const RayScene rays(state.scene());
  ParameterSet found;
  try_edits(state, kFlag, pointer, [&](const SceneDelta& delta) {
    const StepChange change = find_change(rays, state.scene(), delta, state.scene().light_order);
    if (change.colors.parameters.empty() || change.touches_rays() || !is_compressible(change.colors)) return false;
    found.add(change.colors.parameters);
    return true;
  });
  if (found.empty()) throw InputError(kFlag, pointer, "no value there changes colours alone");
  return found;
}

}  // namespace relook
