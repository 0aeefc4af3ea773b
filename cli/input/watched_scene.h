// A scene file that another program writes again and again: looked at now and then by size and time, read when it and
// the files that it names have stood still from one look to the next. Exporters write in parts, by rename, or one file
// after the other; what is broken is waited over.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "input/load_scene.h"

namespace relook {

class WatchedScene {
 public:
  /// `view` must outlive it.
  WatchedScene(std::string path, const ViewArguments& view) : path_(std::move(path)), view_(view) {}

  /// What one look has found. Of a scene whose content is the one of the last look that found one: nothing.
  struct Look {
    std::optional<LoadedDocument> scene;  // another content, at rest, sound, with the camera of the view
    Camera camera;                        // of it
    std::string fault;                    // why what is there cannot be read, once for each state of the files
  };
  /// Throws ResourceError.
  [[nodiscard]] Look look();

 private:
  struct Stamp {
    std::uintmax_t bytes = 0;
    std::int64_t modified = 0;
    bool operator==(const Stamp&) const = default;
  };
  using Stamps = std::map<std::filesystem::path, Stamp>;
  [[nodiscard]] Stamps stamps() const;
  void find_named_files();

  std::string path_;
  const ViewArguments& view_;
  std::vector<std::filesystem::path> named_;  // by the file as it was last read, there or not
  Stamps seen_, handled_;
  std::string hash_;
};

}  // namespace relook
