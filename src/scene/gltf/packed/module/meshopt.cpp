// A part of the module behind scene/gltf/packed/mesh_library.h: meshoptimizer's decoders. The only file that sees it.
#include <meshoptimizer.h>

#include "scene/gltf/packed/mesh_library.h"

namespace {

bool decode(const relook::MeshoptStream& stream, unsigned char* out) {
  const unsigned char* const bytes = stream.bytes.data();
  const std::size_t size = stream.bytes.size();
  switch (stream.mode) {
    case relook::MeshoptMode::attributes:
      return meshopt_decodeVertexBuffer(out, stream.count, stream.stride, bytes, size) == 0;
    case relook::MeshoptMode::triangles:
      return meshopt_decodeIndexBuffer(out, stream.count, stream.stride, bytes, size) == 0;
    case relook::MeshoptMode::indices:
      return meshopt_decodeIndexSequence(out, stream.count, stream.stride, bytes, size) == 0;
  }
  return false;
}

void filter(const relook::MeshoptStream& stream, unsigned char* out) {
  switch (stream.filter) {
    case relook::MeshoptFilter::none:
      return;
    case relook::MeshoptFilter::octahedral:
      return meshopt_decodeFilterOct(out, stream.count, stream.stride);
    case relook::MeshoptFilter::quaternion:
      return meshopt_decodeFilterQuat(out, stream.count, stream.stride);
    case relook::MeshoptFilter::exponential:
      return meshopt_decodeFilterExp(out, stream.count, stream.stride);
  }
}

}  // namespace

extern "C" [[gnu::visibility("default")]] bool relook_unpack_meshopt(const relook::MeshoptStream& stream,
                                                                     unsigned char* out) {
  if (!decode(stream, out)) return false;
  filter(stream, out);
  return true;
}
