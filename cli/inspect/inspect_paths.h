#pragma once
#include "options/arguments.h"
#include "terminal/console.h"

namespace relook {

/// `inspect SCENE|CACHE --paths [FILTER]`: a line each `pointer = value   (range, class, unit)`, the class being what a
/// usual change has. FILTER is a part of the pointer, or with * or ? a pattern of all of it; case counts for nothing.
void inspect_paths(const Arguments& arguments, Console& console);

}  // namespace relook
