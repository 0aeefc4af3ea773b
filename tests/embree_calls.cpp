#include "embree_calls.h"

#include <array>
#include <cstring>
#include <map>
#include <mutex>
#include <set>

namespace relook {
namespace {

using RayKey = std::array<float, 6>;  // origin and direction

struct Calls {
  std::mutex mutex;
  bool is_counting = false;
  std::map<const void*, std::size_t> instances;  // by top level
  std::uint64_t rays = 0, shadows = 0;
  std::set<RayKey> rays_of_one, shadows_of_one;
};

Calls& calls() {
  static Calls all;
  return all;
}

/// Embree's RTCRay and RTCRayHit begin with origin, tnear, direction.
RayKey key_of(const void* ray) {
  std::array<float, 7> start{};
  std::memcpy(start.data(), ray, sizeof start);
  return {start[0], start[1], start[2], start[4], start[5], start[6]};
}

void note(const void* scene, const void* ray, bool is_shadow) {
  Calls& all = calls();
  const std::lock_guard lock(all.mutex);
  if (!all.is_counting) return;
  if (all.instances[scene] > 2)  // an object alone is there twice
    ++(is_shadow ? all.shadows : all.rays);
  else
    (is_shadow ? all.shadows_of_one : all.rays_of_one).insert(key_of(ray));
}

}  // namespace

EmbreeCallCounter::EmbreeCallCounter() {
  const std::lock_guard lock(calls().mutex);
  calls().is_counting = true;
}
EmbreeCallCounter::~EmbreeCallCounter() {
  (void)take();
  const std::lock_guard lock(calls().mutex);
  calls().is_counting = false;
  calls().instances.clear();
}

EmbreeCalls EmbreeCallCounter::take() {
  Calls& all = calls();
  const std::lock_guard lock(all.mutex);
  const EmbreeCalls taken{all.rays, all.shadows, all.rays_of_one.size() + all.shadows_of_one.size()};
  all.rays = all.shadows = 0;
  all.rays_of_one.clear();
  all.shadows_of_one.clear();
  return taken;
}

}  // namespace relook

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): the linker's names
void __real_rtcIntersect1(void* scene, void* second, void* third);
void __real_rtcOccluded1(void* scene, void* second, void* third);
void __real_rtcAttachGeometryByID(void* scene, void* geometry, unsigned id);

// Embree 3 takes the ray last, Embree 4 second.
#if __has_include(<embree4/rtcore.h>)
void __wrap_rtcIntersect1(void* scene, void* ray, void* arguments) {
  relook::note(scene, ray, false);
  __real_rtcIntersect1(scene, ray, arguments);
}
void __wrap_rtcOccluded1(void* scene, void* ray, void* arguments) {
  relook::note(scene, ray, true);
  __real_rtcOccluded1(scene, ray, arguments);
}
#else
void __wrap_rtcIntersect1(void* scene, void* context, void* ray) {
  relook::note(scene, ray, false);
  __real_rtcIntersect1(scene, context, ray);
}
void __wrap_rtcOccluded1(void* scene, void* context, void* ray) {
  relook::note(scene, ray, true);
  __real_rtcOccluded1(scene, context, ray);
}
#endif

void __wrap_rtcAttachGeometryByID(void* scene, void* geometry, unsigned id) {
  {
    const std::lock_guard lock(relook::calls().mutex);
    relook::calls().instances[scene] = id + std::size_t{1};
  }
  __real_rtcAttachGeometryByID(scene, geometry, id);
}
// NOLINTEND(bugprone-reserved-identifier)
}
