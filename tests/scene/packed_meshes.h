// A square as Draco data, written to a file and imported: for tests of compressed meshes.
#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/import_memory.h"
#include "packed_files.h"
#include "run_program.h"
#include "scene/gltf/import.h"

namespace relook {

inline const std::vector<float> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.25F};
inline const std::vector<float> kUvs = {0, 0, 1, 0, 0, 1, 0.5F, 0.75F};
inline const std::vector<std::uint8_t> kIndices = {0, 1, 2, 2, 1, 3};

class PackedMeshes : public testing::Test {
 protected:
  ~PackedMeshes() override { set_import_memory(kImportMemory); }

  [[nodiscard]] std::filesystem::path written(const SceneFile& file) const {
    std::ofstream(folder_ / "scene.glb", std::ios::binary) << file.glb();
    return folder_ / "scene.glb";
  }
  [[nodiscard]] ImportedGltf imported(const SceneFile& file) const { return import_gltf(written(file)); }
  /// The message after the file's name; "" if the file is accepted.
  [[nodiscard]] std::string refusal(const SceneFile& file) const {
    const std::filesystem::path path = written(file);
    try {
      (void)import_gltf(path);
    } catch (const Error& error) {
      return std::string(error.what()).substr(path.string().size() + 2);
    }
    return "";
  }

  /// What is wrong about a file, and what is said about it.
  struct Change {
    const char* pointer;  // in the JSON
    Json value;           // null: removed
    const char* message;  // a part of it
  };

  ScratchFolder folder_{"packed_meshes"};
};

/// A square of Draco data alone: no accessor has a view.
inline SceneFile draco_square(const std::string& draco) {
  SceneFile file = square();
  file.binary.clear();
  file.gltf["bufferViews"] = Json::array();
  file.gltf.erase("extensions");
  file.gltf.erase("extensionsUsed");
  file.gltf["nodes"] = {{{"mesh", 0}}};
  file.gltf["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}},
                            {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 6}},
                            {{"componentType", 5126}, {"type", "VEC2"}, {"count", 4}}};
  const std::size_t view = file.add_view<char>({draco.begin(), draco.end()});
  file.primitive() = {
      {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}},
      {"indices", 1},
      {"extensions",
       {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", 7}, {"TEXCOORD_0", 3}}}}}}}};
  file.gltf["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

inline std::vector<DracoColumn> square_columns() {
  return {{7, 0, 9, 3, bytes_of_numbers(kCorners)}, {3, 3, 9, 2, bytes_of_numbers(kUvs)}};
}
inline std::string draco_square_data(DracoCounts counts = {}) {
  return draco_mesh(kIndices, 4, square_columns(), counts);
}
inline SceneFile draco_square() { return draco_square(draco_square_data()); }
inline Json& draco_extension_of(SceneFile& file) { return file.primitive()["extensions"]["KHR_draco_mesh_compression"]; }

}  // namespace relook
