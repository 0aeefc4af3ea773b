// A scene file or a cache as a look document to read, or to try journals on: for verbs that render nothing.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "options/arguments.h"
#include "scene/compile/state.h"
#include "terminal/console.h"

namespace relook {

/// Whether a path is a cache: a folder with a manifest.
[[nodiscard]] bool is_cache_folder(const std::filesystem::path& path);

/// The state a journal is tried on. Edits of the active camera are refused when there is one: that of a cache, of
/// --camera, or the only one of the scene. Warnings of the scene are printed. Throws UsageError where an output is a
/// file of the scene, and for a view of a cache, which has its own.
[[nodiscard]] SceneState open_look_state(const std::string& path, const Arguments& arguments, Console& console);

}  // namespace relook
