#include "replay/memory_needs.h"

#include <vector>

namespace relook {
namespace {

constexpr std::uint64_t kMegabyte = 1 << 20;

// Measured on scenes/garden and scenes/spheres, with Embree 3.13.
constexpr std::uint64_t kTriangleBytes = 100, kInstanceBytes = 400;  // of acceleration structures
constexpr std::uint64_t kObjectBytes = 400;                          // of a scene compiled and made ready for rays
constexpr std::uint64_t kWorkBytes = 12 * kMegabyte, kThreadBytes = 2 * kMegabyte;
constexpr std::uint64_t kFramePixelBytes = 4;  // of a frame on its way to disk
constexpr std::uint64_t kRenderWorkBytes = 4 * kMegabyte, kRenderThreadBytes = 4 * kMegabyte;

std::uint64_t living_objects(const Scene& scene) {
  std::uint64_t living = 0;
  for (const Object& object : scene.objects) living += object.alive ? 1 : 0;
  return living;
}

std::uint64_t structures_bytes(const Scene& scene) {
  std::vector<bool> is_used(scene.assets->meshes.size());
  for (const Object& object : scene.objects)
    if (object.alive) is_used[object.mesh.index()] = true;
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < is_used.size(); ++i)
    if (is_used[i]) triangles += scene.assets->meshes[i].triangles.size();
  return triangles * kTriangleBytes + living_objects(scene) * kInstanceBytes;
}

}  // namespace

MemoryNeeds memory_needs(const Scene& scene, std::size_t threads, const ReplayWork& work) {
  const std::uint64_t pixels = std::uint64_t{scene.camera.width} * scene.camera.height;
  const std::uint64_t structures = structures_bytes(scene);
  MemoryNeeds needs;
  needs.change_bytes = kWorkBytes + threads * kThreadBytes + pixels * kFramePixelBytes;
  if (work.shoots_rays) needs.structures_bytes = structures;
  if (work.writes_page) needs.aside_bytes = kPageBytes;
  if (work.renders_aside)
    needs.aside_bytes = structures + living_objects(scene) * kObjectBytes + pixels * sizeof(Rgba) + kRenderWorkBytes +
                        threads * kRenderThreadBytes;
  return needs;
}

}  // namespace relook
