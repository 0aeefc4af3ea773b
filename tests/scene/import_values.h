// A glTF file goes in, written into a folder with a folder inside; what the importer makes of it comes out.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "gltf_writer.h"
#include "scene/gltf/import.h"
#include "scene/gltf/import_rules.h"

namespace relook {

class ImportValues : public testing::Test {
 protected:
  struct Answer {
    std::string error;  // "" if the file is accepted
    ImportedGltf imported;
  };

  ImportValues() { std::filesystem::create_directories(folder_ / "inner"); }
  ~ImportValues() override {
    set_import_rules({});
    std::filesystem::remove_all(folder_);
  }
  void write(const std::filesystem::path& name, std::string_view bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  [[nodiscard]] Answer answer(std::string_view bytes, const char* name = "inner/scene.glb") const {
    write(name, bytes);
    Answer result;
    try {
      result.imported = import_gltf(folder_ / name);
    } catch (const InputError& error) {
      result.error = error.what();
    }
    return result;
  }
  [[nodiscard]] Answer answer(const SceneFile& file) const { return answer(file.glb()); }
  /// The square's JSON as a .gltf, its buffer beside it.
  [[nodiscard]] Json text_scene() const {
    const SceneFile file = square();
    write("inner/data.bin", file.binary);
    Json gltf = file.gltf;
    gltf["buffers"] = {{{"byteLength", file.binary.size()}, {"uri", "data.bin"}}};
    return gltf;
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("relook_values_" + std::to_string(::getpid()));
};

}  // namespace relook
