#include "packed_files.h"

#include <meshoptimizer.h>

#include <algorithm>

namespace relook {
namespace {

void add_varint(std::string& out, std::uint64_t value) {
  for (; value >= 128; value >>= 7) out += static_cast<char>(value % 128 + 128);
  out += static_cast<char>(value);
}

void add_byte(std::string& out, std::size_t value) { out += static_cast<char>(value); }

}  // namespace

std::string draco_mesh(const std::vector<std::uint8_t>& indices, std::size_t points,
                       const std::vector<DracoColumn>& columns, DracoCounts counts) {
  std::string out = "DRACO";
  for (const std::size_t byte : {counts.major, counts.minor, counts.kind, counts.method}) add_byte(out, byte);
  out.append(2, '\0');  // flags
  add_varint(out, counts.faces == UINT64_MAX ? indices.size() / 3 : counts.faces);
  add_varint(out, counts.points == UINT64_MAX ? points : counts.points);
  add_byte(out, 1);  // indices as they are
  for (const std::uint8_t index : indices) {
    add_byte(out, index);
    if (points >= 256) add_byte(out, 0);  // two bytes each then
  }
  add_byte(out, 1);  // one decoder for all attributes
  add_varint(out, columns.size());
  for (const DracoColumn& column : columns) {
    for (const std::size_t byte : {column.semantic, column.data_type, column.width}) add_byte(out, byte);
    add_byte(out, 0);  // not normalized
    add_varint(out, column.id);
  }
  out.append(columns.size(), '\0');  // values as they are
  for (const DracoColumn& column : columns) out += column.bytes;
  return out;
}

std::string meshopt_attributes(const std::string& bytes, std::size_t count, std::size_t stride) {
  std::string out(meshopt_encodeVertexBufferBound(count, stride), '\0');
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), bytes.data(), count,
                                        stride));
  return out;
}

std::string meshopt_triangles(const std::vector<std::uint32_t>& indices) {
  const std::size_t vertices = *std::ranges::max_element(indices) + std::size_t{1};
  std::string out(meshopt_encodeIndexBufferBound(indices.size(), vertices), '\0');
  meshopt_encodeIndexVersion(1);
  out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), indices.data(),
                                       indices.size()));
  return out;
}

std::string meshopt_indices(const std::vector<std::uint32_t>& indices) {
  const std::size_t vertices = *std::ranges::max_element(indices) + std::size_t{1};
  std::string out(meshopt_encodeIndexSequenceBound(indices.size(), vertices), '\0');
  meshopt_encodeIndexVersion(1);
  out.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(out.data()), out.size(), indices.data(),
                                         indices.size()));
  return out;
}

std::size_t add_meshopt_view(SceneFile& file, const std::string& packed, std::size_t count, std::size_t stride,
                             const char* mode, const char* filter, const char* name) {
  file.binary.resize((file.binary.size() + 3) / 4 * 4, '\0');
  const Json extension = {{"buffer", 0},
                          {"byteOffset", file.binary.size()},
                          {"byteLength", packed.size()},
                          {"byteStride", stride},
                          {"count", count},
                          {"mode", mode},
                          {"filter", filter}};
  file.binary += packed;
  const std::size_t bytes = count * stride;
  if (file.other_buffers.empty()) file.other_buffers = {{{"byteLength", 0}}};
  Json& total = file.other_buffers[0]["byteLength"];
  Json view = {{"buffer", 1}, {"byteOffset", total}, {"byteLength", bytes}, {"extensions", {{name, extension}}}};
  if (mode == std::string_view("ATTRIBUTES")) view["byteStride"] = stride;
  total = total.get<std::size_t>() + (bytes + 3) / 4 * 4;
  file.gltf["bufferViews"].push_back(view);
  return file.gltf["bufferViews"].size() - 1;
}

}  // namespace relook
