// What tunnels cost in a cache, and what a replay gains that finds them there.
#pragma once
#include "setup.h"

namespace relook {

/// `options`: journal "-": the first mesh node is moved a little. Throws InputError if there is nothing to move.
void print_tunnels(const BenchOptions& options);

}  // namespace relook
