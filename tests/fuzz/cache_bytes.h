// A cache as the bytes of its sections, to be changed and written back with every size and hash mended.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/json.h"
#include "fuzz_case.h"

namespace relook {

struct CacheBytes {
  struct Section {
    std::string name;
    std::uint32_t stride = 1;
    Bytes raw;  // unpacked
  };
  struct File {
    std::string stem;  // name without hash: "trees/00000-"
    std::vector<Section> sections;
    bool is_there = true;
  };
  Json content;             // of MANIFEST.json
  Json look;                // look.json
  std::vector<File> files;  // the .rlk files by name, those of tunnels last

  /// Of a sound cache.
  [[nodiscard]] static CacheBytes of(const std::filesystem::path& cache);
  /// Changes one thing: a file, a section, a value.
  void change(Choices& choices);
  /// Into an empty folder.
  void write(const std::filesystem::path& cache);
};

}  // namespace relook
