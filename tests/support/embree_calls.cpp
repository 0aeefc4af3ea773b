#include "embree_calls.h"

#include <algorithm>
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
  std::map<const void*, const void*> device_of;  // by scene
  std::map<const void*, std::size_t> instances;  // by top level
  std::uint64_t rays = 0, shadows = 0;
  struct OfDevice {
    std::uint64_t calls = 0;
    std::set<RayKey> rays, shadows;
  };
  std::map<const void*, OfDevice> of_one;  // against levels of one object, by device
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

void add_of_one(Calls::OfDevice& device, const void* ray, bool is_shadow) {
  ++device.calls;
  (is_shadow ? device.shadows : device.rays).insert(key_of(ray));
}

void note(const void* scene, const void* ray, bool is_shadow) {
  Calls& all = calls();
  const std::lock_guard lock(all.mutex);
  if (!all.is_counting) return;
  if (all.instances[scene] > 2)  // an object alone is there twice
    ++(is_shadow ? all.shadows : all.rays);
  else
    add_of_one(all.of_one[all.device_of[scene]], ray, is_shadow);
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
  calls().device_of.clear();
}

EmbreeCalls EmbreeCallCounter::take() {
  Calls& all = calls();
  const std::lock_guard lock(all.mutex);
  EmbreeCalls taken{all.rays, all.shadows, 0, 0};
  for (const auto& [device, of_one] : all.of_one) {
    const bool has_scene = std::ranges::any_of(all.instances, [&, d = device](const auto& level) {
      return level.second > 2 && all.device_of[level.first] == d;
    });
    if (has_scene)
      taken.tests += of_one.rays.size() + of_one.shadows.size();
    else
      taken.objects += of_one.calls;
  }
  all.rays = all.shadows = 0;
  all.of_one.clear();
  return taken;
}

}  // namespace relook

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): the linker's names
void __real_rtcIntersect1(void* scene, void* second, void* third);
void __real_rtcOccluded1(void* scene, void* second, void* third);
void* __real_rtcNewDevice(const char* config);
void* __real_rtcNewScene(void* device);
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

void* __wrap_rtcNewDevice(const char* config) {
  void* const device = __real_rtcNewDevice(config);
  relook::Calls& all = relook::calls();
  const std::lock_guard lock(all.mutex);
  // Scenes of another device that was at the same address are gone with it.
  std::erase_if(all.instances, [&](const auto& level) { return all.device_of[level.first] == device; });
  std::erase_if(all.device_of, [&](const auto& scene) { return scene.second == device; });
  return device;
}

void* __wrap_rtcNewScene(void* device) {
  void* scene = __real_rtcNewScene(device);
  const std::lock_guard lock(relook::calls().mutex);
  relook::calls().device_of[scene] = device;
  relook::calls().instances.erase(scene);  // of another one at the same address
  return scene;
}

void __wrap_rtcAttachGeometryByID(void* scene, void* geometry, unsigned id) {
  {
    const std::lock_guard lock(relook::calls().mutex);
    relook::calls().instances[scene] = id + std::size_t{1};
  }
  __real_rtcAttachGeometryByID(scene, geometry, id);
}
// NOLINTEND(bugprone-reserved-identifier)
}
