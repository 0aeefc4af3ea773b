// The decoders of compressed meshes at arm's length: Draco and meshoptimizer stand in a module of its own that is
// loaded when the first compressed mesh is read. Debian's libdraco also exports a tinygltf of its own, of another
// version, under the names of ours: nothing that links to tinygltf may link to it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace relook {

/// What EXT_meshopt_compression calls "mode" and "filter".
enum class MeshoptMode : std::uint8_t { attributes, triangles, indices };
enum class MeshoptFilter : std::uint8_t { none, octahedral, quaternion, exponential };

/// A compressed buffer view. Requires: the mode has this stride and count, the filter this stride.
struct MeshoptStream {
  std::span<const unsigned char> bytes;
  std::size_t count = 0, stride = 0;  // of what comes out: elements, bytes from one to the next
  MeshoptMode mode = MeshoptMode::attributes;
  MeshoptFilter filter = MeshoptFilter::none;
};

/// What the module exports as relook_unpack_meshopt: fills `out`, count * stride bytes. False: the data is damaged.
using UnpackMeshopt = bool(const MeshoptStream& stream, unsigned char* out);

/// glTF's numbers of the component types that a Draco attribute is converted to.
enum class DracoComponent : std::uint16_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

/// A Draco mesh, decoded.
class DracoMesh {
 public:
  virtual ~DracoMesh() = default;
  [[nodiscard]] virtual std::size_t faces() const = 0;
  [[nodiscard]] virtual std::size_t points() const = 0;
  /// 3 * faces() indices, all below points().
  virtual void read_faces(std::uint32_t* indices) const = 0;
  /// How many numbers the attribute has a point; none without such an attribute.
  [[nodiscard]] virtual std::optional<std::size_t> width(std::uint32_t attribute) const = 0;
  /// All points' numbers, tightly packed. False: one does not fit the type. Requires: width(attribute).
  [[nodiscard]] virtual bool read(std::uint32_t attribute, DracoComponent type, void* out) const = 0;
};

/// What a Draco stream may declare and hold.
struct DracoLimits {
  std::uint64_t faces = 0, points = 0;
  /// Asked before memory is taken, with the bytes that decoding holds beside what it held before; false ends it.
  std::function<bool(std::uint64_t bytes)> may_hold;
};

struct DracoResult {
  std::unique_ptr<DracoMesh> mesh;  // null: `error` says why
  std::string error;
  bool is_newer = false;  // the error: a bitstream that this decoder does not know
};

/// What the module exports as relook_open_draco.
using OpenDraco = DracoResult(std::span<const unsigned char> bytes, const DracoLimits& limits);

/// Load the module on first use: from the program's folder or, installed, ../lib/relook. Throw Error if it is missing.
[[nodiscard]] bool unpack_meshopt(const MeshoptStream& stream, unsigned char* out);
[[nodiscard]] DracoResult open_draco(std::span<const unsigned char> bytes, const DracoLimits& limits);

}  // namespace relook
