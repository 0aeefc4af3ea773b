#include "input/open_look.h"

#include <memory>
#include <utility>

#include "base/error.h"
#include "input/load_cache.h"
#include "input/load_scene.h"
#include "options/outputs.h"

namespace relook {

bool is_cache_folder(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_directory(path, error) && std::filesystem::exists(path / "MANIFEST.json", error);
}

SceneState open_look_state(const std::string& path, const Arguments& arguments, Console& console) {
  std::error_code error;
  const ViewArguments& view = arguments.view;
  if (std::filesystem::is_directory(path, error)) {
    const char* const option = !view.camera.empty()       ? "--camera"
                               : view.auto_lights         ? "--lights"
                               : !view.look_patch.empty() ? "--look"
                                                          : nullptr;
    if (option != nullptr)
      throw UsageError(std::string(option) + ": " + path + " is a cache, whose look and view are fixed");
    CacheContent content = load_cache(path);
    return {std::move(content.document), content.camera, content.pyramids, content.image.view.integrator};
  }
  LoadedDocument loaded = load_document(path, view);
  require_not_outputs(arguments, loaded.files, "a file of the scene");
  const Camera camera = set_up_inspection(loaded, view);
  console.warn(loaded.warnings);
  return {std::move(loaded.document), camera, std::make_shared<PyramidStore>(), view.sampling.integrator};
}

}  // namespace relook
