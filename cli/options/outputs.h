// What a verb writes, held against what it reads and what is there: no output names an input, whatever the spelling or
// the links, and nothing that relook has not written is replaced unless --overwrite is given.
#pragma once
#include <filesystem>
#include <span>
#include <string_view>

#include "options/arguments.h"

namespace relook {

/// Checks all outputs that the command line names; to be called before any work. Throws UsageError.
void check_outputs(const Arguments& arguments);

/// For inputs that only become known while others are read, such as the images of a scene. `what`: "a file of the
/// scene". Throws UsageError when an output is one of them.
void require_not_outputs(const Arguments& arguments, std::span<const std::filesystem::path> inputs,
                         std::string_view what);

}  // namespace relook
