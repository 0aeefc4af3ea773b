// The structures that a replay of a cache works with.
#pragma once
#include "base/json.h"
#include "options/arguments.h"
#include "terminal/console.h"

namespace relook {

/// The structures of the cache, where the command line does not say otherwise; in words, what becomes of its tunnels if
/// it does. `manifest`: of the cache.
void take_structures_of(const Json& manifest, Arguments& arguments, Console& console);

}  // namespace relook
