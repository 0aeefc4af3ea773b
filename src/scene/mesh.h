// What a look document names but does not contain: meshes, each a glTF primitive as triangles in object space, and
// encoded images. Made by the importer or read from a cache; those that are there never change, edits may add more.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/id.h"
#include "base/math.h"

namespace relook {

/// What one morph target adds to each vertex at a weight of 1 (glTF 2.0 section 3.7.2.2). Each column is empty, where
/// it adds nothing, or as long as the mesh's positions.
struct MorphTarget {
  std::vector<Point> positions;
  std::vector<Normal> normals;
  std::vector<Direction> tangents;
  bool operator==(const MorphTarget&) const = default;
};

/// One glTF mesh primitive. Invariants: every index < positions.size(); optional columns are empty or as long as
/// positions; everything is finite.
struct Mesh {
  std::string name;                                     // look-document name of the glTF mesh
  std::uint32_t primitive = 0;                          // which primitive of that mesh
  std::vector<Point> positions;                         // object space, metres
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from the front
  std::vector<Normal> normals;                          // unit; empty: flat shading by the geometric normal
  std::vector<Imath::V4f> tangents;                     // xyz unit, w handedness; empty: from the uv of each triangle
  std::array<std::vector<Uv>, 2> uv;                    // TEXCOORD_0 and _1
  std::vector<Rgba> colors;                             // COLOR_0, linear; a = coverage
  float min_alpha = 1;                                  // smallest colors[].a, 1 without colours
  Box bounds;                                           // object space
  std::vector<MorphTarget> targets;                     // by index of a weight
  std::vector<std::uint16_t> joints;                    // [positions][influences], 0 where the weight is; or empty
  std::vector<float> joint_weights;                     // the same; not negative, the sum of a vertex is 1

  /// The least number of joints that a skin of this mesh has; 0 for a mesh that is not skinned.
  [[nodiscard]] std::size_t joint_count() const;
};

inline std::size_t Mesh::joint_count() const {
  std::size_t count = 0;
  for (const std::uint16_t joint : joints) count = std::max(count, std::size_t{joint} + 1);
  return count;
}

/// An image as it was in the file: decoded only when a pyramid of it is needed.
struct EncodedImage {
  std::string name;                     // look-document name
  std::shared_ptr<const Bytes> bytes;   // PNG, JPEG, WebP, Radiance HDR or OpenEXR; null: the file had none
};

/// Meshes and images by the names that a look document has for them.
struct Assets {
  std::deque<Mesh> meshes;  // indexed by MeshId; addresses stay valid when meshes are added
  std::map<std::string, std::vector<MeshId>, std::less<>> mesh_primitives;  // look name of a mesh -> its primitives
  std::map<std::string, EncodedImage, std::less<>> images;                  // by look name
};

}  // namespace relook
