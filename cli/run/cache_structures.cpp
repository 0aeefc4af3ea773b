#include "run/cache_structures.h"

#include "input/load_cache.h"
#include "options/needless_options.h"

namespace relook {

void take_structures_of(const Json& manifest, Arguments& arguments, Console& console) {
  const Json& storage = manifest["content"]["storage"];
  const auto number = [&](const char* key) { return storage[key].get<std::uint32_t>(); };
  StructureOptions stored = usual_structures(integrator_of(manifest));
  stored.groups = number("groups");
  stored.atoms = number("atoms");
  stored.color_trees_percent = storage["color_trees_percent"].get<double>();
  const bool has_tunnels = number("tunnels") > 0;
  if (has_tunnels) {
    stored.tunnels = number("tunnels");
    stored.tunnel_levels = number("tunnel_levels");
    if (!storage["most_tunnels"].is_null()) stored.most_tunnels = storage["most_tunnels"].get<std::uint64_t>();
  }
  const Integrator integrator = integrator_of(manifest);
  console.warn(idle_structures_warning(arguments, integrator));
  take_structures(stored, integrator, arguments);
  const StructureOptions& wanted = arguments.structures;
  const bool is_same = wanted.tunnels == stored.tunnels && wanted.tunnel_levels == stored.tunnel_levels &&
                       wanted.most_tunnels == stored.most_tunnels &&
                       (stored.tunnels < 2 || wanted.atoms == stored.atoms);
  if (has_tunnels && wanted.tunnels > 0 && !is_same)
    console.warn({arguments.inputs[0] + ": its tunnels are of other --tunnels, --tunnel-levels, --most-tunnels or " +
                  "--atoms; others are built when a step needs them"});
}

}  // namespace relook
