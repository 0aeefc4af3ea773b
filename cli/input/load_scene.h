// From a scene file and the VIEW options to a compiled scene with a camera and lights.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "options/arguments.h"
#include "scene/compile/state.h"
#include "scene/look/look.h"

namespace relook {

struct LoadedScene {
  std::unique_ptr<SceneState> state;
  std::string hash;                          // XXH3-128 of the scene's content, the look patch and --lights
  std::vector<std::filesystem::path> files;  // that the scene and the patch name
  std::vector<std::string> warnings;
};

/// The look document of a scene with --look applied, and what load_scene() needs beside it.
struct LoadedDocument {
  LookDocument document;
  std::string hash;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> warnings;
};
[[nodiscard]] LoadedDocument load_document(const std::string& path, const ViewArguments& view);

/// The camera of --camera; without it the scene's only or first one, with a warning when it has several. Adds the
/// lights of --lights.
[[nodiscard]] Camera set_up_view(LoadedDocument& loaded, const ViewArguments& view);
/// The same for a scene that is looked at and not rendered: one without a camera is framed.
[[nodiscard]] Camera set_up_inspection(LoadedDocument& loaded, ViewArguments view);

/// Applies --look, then --camera and --lights. Throws InputError that names the flag when the scene has no camera or no
/// light.
[[nodiscard]] LoadedScene load_scene(const std::string& path, const ViewArguments& view);

}  // namespace relook
