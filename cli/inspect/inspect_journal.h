// `inspect JOURNAL`: its steps and, with --scene, the class of each and why, without rendering.
#pragma once
#include "options/arguments.h"
#include "terminal/console.h"

namespace relook {

void inspect_journal(const Arguments& arguments, Console& console);

}  // namespace relook
