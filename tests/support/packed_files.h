// Draco data and meshopt streams of the tests' own making.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gltf_writer.h"
#include "scene/gltf/packed/mesh_library.h"

namespace relook {

/// An attribute of a Draco mesh. The numbers are stored as they are.
struct DracoColumn {
  std::uint32_t id = 0;
  std::uint8_t semantic = 0;   // Draco's: 0 position, 1 normal, 2 colour, 3 texture coordinates, 4 other
  std::uint8_t data_type = 9;  // Draco's: 2 uint8, 4 uint16, 9 float
  std::uint8_t width = 3;
  std::string bytes;
};

template <class Number>
std::string bytes_of_numbers(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

/// What the headers of a Draco mesh say; the defaults are what is there.
struct DracoCounts {
  std::uint64_t faces = UINT64_MAX, points = UINT64_MAX;
  std::uint8_t major = 2, minor = 2, kind = 1, method = 0;
};

/// Draco bitstream 2.2, sequential method, nothing compressed: fewer than 2^16 points.
[[nodiscard]] std::string draco_mesh(const std::vector<std::uint8_t>& indices, std::size_t points,
                                     const std::vector<DracoColumn>& columns, DracoCounts counts = {});

/// Encodes `count` elements of `stride` bytes; indices with 4 bytes each.
[[nodiscard]] std::string meshopt_attributes(const std::string& bytes, std::size_t count, std::size_t stride);
[[nodiscard]] std::string meshopt_triangles(const std::vector<std::uint32_t>& indices);
[[nodiscard]] std::string meshopt_indices(const std::vector<std::uint32_t>& indices);

/// A view whose data is `packed`: in another buffer without data, as gltfpack writes it. Returns its number.
std::size_t add_meshopt_view(SceneFile& file, const std::string& packed, std::size_t count, std::size_t stride,
                             const char* mode, const char* filter = "NONE",
                             const char* name = "EXT_meshopt_compression");

}  // namespace relook
