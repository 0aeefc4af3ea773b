#include "input/watched_scene.h"

#include <utility>

#include "base/error.h"
#include "scene/gltf/gltf_source.h"

namespace relook {

WatchedScene::Stamps WatchedScene::stamps() const {
  Stamps stamps;
  const auto add = [&](const std::filesystem::path& path) {
    std::error_code error;
    Stamp stamp;
    stamp.bytes = std::filesystem::file_size(path, error);
    if (error) stamp.bytes = 0;
    const auto time = std::filesystem::last_write_time(path, error);
    if (!error) stamp.modified = time.time_since_epoch().count();
    stamps[path] = stamp;
  };
  add(path_);
  for (const std::filesystem::path& path : named_) add(path);
  return stamps;
}

/// Of a file that cannot be read the names stay those of the last one.
void WatchedScene::find_named_files() {
  try {
    const GltfSource source = read_gltf_source(path_);
    std::vector<std::filesystem::path> named;
    for (const char* section : {"buffers", "images"}) {
      const auto entries = source.json.find(section);
      if (entries == source.json.end() || !entries->is_array()) continue;
      for (const Json& entry : *entries) {
        const Json uri = entry.is_object() ? entry.value("uri", Json()) : Json();
        if (uri.is_string() && uri.get_ref<const std::string&>().find(':') == std::string::npos)
          named.push_back(source.folder / percent_decoded(uri.get<std::string>(), path_, ""));
      }
    }
    named_ = std::move(named);
  } catch (const InputError&) {  // is said where the scene is read
  }
}

WatchedScene::Look WatchedScene::look() {
  Look look;
  const Stamps now = stamps();
  if (now == handled_) return look;
  if (now != std::exchange(seen_, now)) return look;
  find_named_files();
  const Stamps before = stamps();
  try {
    LoadedDocument loaded = load_document(path_, view_);
    look.camera = set_up_inspection(loaded, view_);
    if (stamps() != before) return look;  // written meanwhile
    if (loaded.hash != hash_) {
      hash_ = loaded.hash;
      look.scene = std::move(loaded);
    }
  } catch (const InputError& error) {
    if (stamps() != before) return look;
    look.fault = error.what();
  }
  handled_ = seen_ = before;
  return look;
}

}  // namespace relook
