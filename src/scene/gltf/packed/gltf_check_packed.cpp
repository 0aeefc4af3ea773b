// The extensions of compressed data: references and ranges. What the decoders know is for gltf_meshopt.cpp and
// gltf_draco.cpp, which look at the data that is used.
#include "scene/gltf/check/gltf_check.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/packed/gltf_unpack.h"

namespace relook {

void check_meshopt_view(const JsonView& root, const JsonView& view) {
  const auto packed = meshopt_extension(view);
  if (!packed) return;
  constexpr std::int64_t kMost = std::int64_t{1} << 40;
  const std::size_t buffer = reference(packed->at("buffer"), array_size(root, "buffers"), "buffer");
  const std::int64_t buffer_bytes = root.at("buffers").at(buffer).at("byteLength").integer(1, kMost);
  const auto offset = member(*packed, "byteOffset");
  const std::int64_t end = (offset ? offset->integer(0, kMost) : 0) + packed->at("byteLength").integer(1, kMost);
  if (end > buffer_bytes)
    packed->fail("reaches to byte " + std::to_string(end) + " of a buffer of " + std::to_string(buffer_bytes));
  (void)packed->at("byteStride").integer(1, 256);
  (void)packed->at("count").integer(1, std::int64_t{1} << 32);
  (void)packed->at("mode").text();
  if (const auto filter = member(*packed, "filter")) (void)filter->text();
}

void check_draco_primitive(const JsonView& root, const JsonView& primitive) {
  const auto packed = draco_extension(primitive);
  if (!packed) return;
  (void)reference(packed->at("bufferView"), array_size(root, "bufferViews"), "buffer view");
  const JsonView attributes = packed->at("attributes");
  attributes.require_object();
  for (const auto& [name, id] : attributes.value().items()) (void)attributes.at(name).integer(0, UINT32_MAX);
}

std::vector<bool> accessors_of_draco(const JsonView& root) {
  std::vector<bool> are_packed(array_size(root, "accessors"), false);
  const auto mark = [&](const JsonView& owner, std::string_view key) {
    if (const auto index = optional_reference(owner, key, are_packed.size(), "accessor")) are_packed[*index] = true;
  };
  for_each_object(root, "meshes", [&](const JsonView& mesh, std::size_t) {
    for_each_object(mesh, "primitives", [&](const JsonView& primitive, std::size_t) {
      const auto packed = draco_extension(primitive);
      if (!packed) return;
      mark(primitive, "indices");
      const JsonView names = packed->at("attributes"), attributes = primitive.at("attributes");
      names.require_object();
      attributes.require_object();
      for (const auto& [name, id] : names.value().items()) mark(attributes, name);
    });
  });
  return are_packed;
}

}  // namespace relook
