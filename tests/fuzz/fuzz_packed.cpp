// Compressed meshes: the bytes of a Draco mesh or of a meshopt stream, in a file that declares them rightly, or nearly.
#include <algorithm>
#include <array>

#include "fuzz_case.h"
#include "fuzz_targets.h"
#include "gltf_writer.h"
#include "scene/gltf/import.h"

namespace relook {
namespace {

/// The first bytes choose what the file says; the others are the data.
constexpr std::size_t kChoices = 8;

Json draco_attribute(SceneFile& file, Json& attributes, const char* name, int component, const char* type,
                     std::size_t count) {
  Json accessor = {{"componentType", component}, {"type", type}, {"count", count}};
  if (component != 5126 && name != std::string_view("JOINTS_0")) accessor["normalized"] = true;
  attributes[name] = file.gltf["accessors"].size();
  file.gltf["accessors"].push_back(accessor);
  return attributes.size() - 1;
}

/// Attributes with the ids 0, 1, ..., as encoders number them.
void add_draco(SceneFile& file, std::span<const std::uint8_t> choices, std::size_t view) {
  const std::size_t vertices = choices[1] + std::size_t{choices[2]} * 256 + 1;
  const std::size_t corners = 3 * (choices[3] + std::size_t{choices[4]} * 256 + 1);
  file.gltf["accessors"] = {{{"componentType", 5125}, {"type", "SCALAR"}, {"count", corners}}};
  Json attributes = Json::object(), ids = Json::object();
  const auto add = [&](const char* name, int component, const char* type) {
    ids[name] = draco_attribute(file, attributes, name, component, type, vertices);
  };
  add("POSITION", (choices[5] & 1U) != 0 ? 5122 : 5126, "VEC3");
  if ((choices[5] & 2U) != 0) add("NORMAL", 5126, "VEC3");
  if ((choices[5] & 4U) != 0) add("TEXCOORD_0", 5126, "VEC2");
  if ((choices[5] & 8U) != 0) add("COLOR_0", 5121, "VEC4");
  if ((choices[5] & 16U) != 0) add("JOINTS_0", 5121, "VEC4"), add("WEIGHTS_0", 5126, "VEC4");
  const Json packed = {{"bufferView", view}, {"attributes", ids}};
  const Json primitive = {{"attributes", attributes},
                          {"indices", 0},
                          {"mode", 4 + (choices[6] & 1U)},
                          {"extensions", {{"KHR_draco_mesh_compression", packed}}}};
  file.gltf["meshes"] = {{{"primitives", {primitive}}}};
}

/// The data of positions or of indices, beside plain data of the other.
void add_meshopt(SceneFile& file, std::span<const std::uint8_t> choices, std::size_t data, std::size_t data_bytes) {
  static constexpr std::array<const char*, 4> kModes{"ATTRIBUTES", "TRIANGLES", "INDICES", "FOURTH"};
  static constexpr std::array<const char*, 5> kFilters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};
  const std::size_t mode = choices[1] % kModes.size();
  const std::size_t count = choices[2] + std::size_t{choices[3]} * 256 + 1;
  const std::size_t stride = mode == 0 ? choices[4] : std::size_t{2} << (choices[4] & 1U);
  const Json packed = {{"buffer", 0},
                       {"byteOffset", data},
                       {"byteLength", data_bytes},
                       {"byteStride", stride},
                       {"count", count},
                       {"mode", kModes[mode]},
                       {"filter", kFilters[choices[5] % kFilters.size()]}};
  Json view = {{"buffer", 1}, {"byteOffset", 0}, {"byteLength", std::max<std::size_t>(count * stride, 1)}};
  if (mode == 0) view["byteStride"] = stride;
  view["extensions"] = {{(choices[6] & 1U) != 0 ? "KHR_meshopt_compression" : "EXT_meshopt_compression", packed}};
  file.other_buffers.push_back({{"byteLength", view["byteLength"]}});
  file.gltf["bufferViews"].push_back(view);
  const std::size_t index = file.gltf["bufferViews"].size() - 1;
  Json primitive = {{"attributes", Json::object()}};
  if (mode == 0) {
    const bool is_short = stride < 12;
    primitive["attributes"]["POSITION"] =
        file.add_accessor(index, is_short ? 5122 : 5126, "VEC3", count, {{"normalized", is_short}});
  } else {
    primitive["attributes"]["POSITION"] = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3", 3);
    primitive["indices"] = file.add_accessor(index, stride == 2 ? 5123 : 5125, "SCALAR", count);
  }
  file.gltf["meshes"] = {{{"primitives", {primitive}}}};
}

}  // namespace

int fuzz_packed(const std::uint8_t* data, std::size_t size) {
  begin_fuzz_case();
  if (size <= kChoices) return 0;
  static const FuzzFolder folder("packed");
  const std::span choices(data, kChoices);
  SceneFile file;
  file.binary.assign(reinterpret_cast<const char*>(data) + kChoices, size - kChoices);
  const std::size_t bytes = file.binary.size();
  file.gltf["bufferViews"] = {{{"buffer", 0}, {"byteLength", bytes}}};
  if ((choices[0] & 1U) != 0)
    add_draco(file, choices, 0);
  else
    add_meshopt(file, choices, 0, bytes);
  file.gltf["nodes"] = {{{"mesh", 0}}};
  const std::filesystem::path path = folder.path() / "scene.glb";
  const std::string text = file.glb();
  overwrite_file(path, std::as_bytes(std::span(text)));
  is_answered({ExitCode::bad_input, ExitCode::out_of_resources}, [&] {
    for (const auto& primitives : import_gltf(path).meshes)
      for (const Mesh& mesh : primitives)
        for (const auto& corners : mesh.triangles)
          for (const std::uint32_t corner : corners)
            expect(corner < mesh.positions.size(), "a triangle names no vertex");
  });
  return 0;
}

}  // namespace relook
