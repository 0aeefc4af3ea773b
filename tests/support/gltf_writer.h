// Writes small glTF files for tests of the importer.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/json.h"

namespace relook {

/// A glTF file in the making: JSON plus one buffer, and those that are declared alone.
struct SceneFile {
  Json gltf = {{"asset", {{"version", "2.0"}}}};
  std::string binary;
  Json other_buffers = Json::array();

  template <class Number>
  std::size_t add_view(const std::vector<Number>& values, std::size_t stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(Number)}};
    if (stride != 0) view["byteStride"] = stride;
    binary.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
    gltf["bufferViews"].push_back(view);
    return gltf["bufferViews"].size() - 1;
  }
  std::size_t add_accessor(std::size_t view, int component, const char* type, std::size_t count,
                           Json more = Json::object()) {
    more.update({{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}});
    gltf["accessors"].push_back(more);
    return gltf["accessors"].size() - 1;
  }
  std::size_t floats(const std::vector<float>& values, const char* type, std::size_t width) {
    return add_accessor(add_view(values), 5126, type, values.size() / width);
  }
  Json& primitive() { return gltf["meshes"][0]["primitives"][0]; }

  [[nodiscard]] std::string glb() const {
    Json document = gltf;
    if (!binary.empty()) document["buffers"] = {{{"byteLength", binary.size()}}};
    for (const Json& buffer : other_buffers) document["buffers"].push_back(buffer);
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string chunk = binary;
    chunk.resize((chunk.size() + 3) / 4 * 4, '\0');
    std::string out = "glTF";
    const auto word = [&](std::size_t value) {
      for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift & 0xFF);
    };
    word(2);
    word(12 + 8 + text.size() + (chunk.empty() ? 0 : 8 + chunk.size()));
    word(text.size());
    out += "JSON" + text;
    if (chunk.empty()) return out;
    word(chunk.size());
    out += std::string("BIN\0", 4) + chunk;
    return out;
  }
};

/// Four corners of a square in z = 0, and everything that the checks look at.
inline SceneFile square() {
  SceneFile file;
  const std::size_t positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3", 3);
  const std::size_t indices = file.add_accessor(file.add_view<std::uint16_t>({0, 1, 2, 2, 1, 3}), 5123, "SCALAR", 6);
  file.gltf["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}}}}}};
  file.gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0.5}}},
                             {"extensions", {{"KHR_materials_ior", {{"ior", 1.5}}}}}}};
  file.gltf["textures"] = {{{"sampler", 0}}};
  file.gltf["samplers"] = {{{"wrapS", 10497}}};
  file.gltf["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  file.gltf["nodes"] = {{{"mesh", 0}, {"children", {1, 2}}},
                        {{"camera", 0}, {"translation", {0, 0, 5}}},
                        {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  file.gltf["scenes"] = {{{"nodes", {0}}}};
  file.gltf["scene"] = 0;
  file.gltf["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_ior"};
  file.gltf["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", Json::object()}}}}}}};
  return file;
}

}  // namespace relook
