#include "scene/gltf/packed/mesh_library.h"

#include "base/system/module.h"

namespace relook {
namespace {

constexpr const char* kModule = "librelook_meshes.so";
constexpr const char* kPurpose = "decode compressed meshes";

}  // namespace

bool unpack_meshopt(const MeshoptStream& stream, unsigned char* out) {
  static auto* const unpack =
      reinterpret_cast<UnpackMeshopt*>(module_function(kModule, "relook_unpack_meshopt", kPurpose));
  return unpack(stream, out);
}

DracoResult open_draco(std::span<const unsigned char> bytes, const DracoLimits& limits) {
  static auto* const open = reinterpret_cast<OpenDraco*>(module_function(kModule, "relook_open_draco", kPurpose));
  return open(bytes, limits);
}

}  // namespace relook
