#include "trace/embree_device.h"

#include <new>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"

namespace relook {

// At most AVX2: hosts that share a cache must agree in every bit, so they must run the same code.
EmbreeDevice::EmbreeDevice(MemoryMonitor monitor)
    : monitor_(std::move(monitor)), device_(rtcNewDevice("max_isa=avx2")) {
  if (device_ == nullptr) throw std::bad_alloc();
  if (monitor_) rtcSetDeviceMemoryMonitorFunction(device_, report_memory, this);
}

EmbreeDevice::~EmbreeDevice() {
  rtcSetDeviceMemoryMonitorFunction(device_, nullptr, nullptr);  // a scene may keep the device beyond this
  rtcReleaseDevice(device_);
}

/// False: Embree is to give up. What the monitor throws is kept until Embree has come back with an error.
bool EmbreeDevice::report_memory(void* device, ssize_t bytes, bool /*is_done*/) {
  auto& self = *static_cast<EmbreeDevice*>(device);
  try {
    self.monitor_(bytes);
    return true;
  } catch (...) {
    if (bytes <= 0) return true;  // nothing is taken
    const std::lock_guard lock(self.mutex_);
    if (!self.thrown_) self.thrown_ = std::current_exception();
    return false;
  }
}

void EmbreeDevice::check() {
  set_float_mode();
  const RTCError error = rtcGetDeviceError(device_);
  std::exception_ptr thrown;
  {
    const std::lock_guard lock(mutex_);
    thrown = std::exchange(thrown_, nullptr);
  }
  if (thrown) std::rethrow_exception(thrown);
  if (error == RTC_ERROR_CANCELLED) stop_if_interrupted();
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error != RTC_ERROR_NONE)
    throw ResourceError("", "Embree cannot build an acceleration structure (its error " +
                                std::to_string(static_cast<int>(error)) + ")");
}

template <class Handle>
Handle EmbreeDevice::checked(Handle handle) {
  if (handle) return handle;
  check();
  throw std::bad_alloc();
}

SceneHandle EmbreeDevice::new_scene() {
  SceneHandle scene = checked(SceneHandle(rtcNewScene(device_)));
  rtcSetSceneProgressMonitorFunction(
      scene.get(), [](void*, double) { return !is_interrupted(); }, nullptr);
#if RTC_VERSION_MAJOR >= 4
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS);
#else
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
#endif
  return scene;
}

GeometryHandle EmbreeDevice::new_geometry(RTCGeometryType type) {
  return checked(GeometryHandle(rtcNewGeometry(device_, type)));
}

}  // namespace relook
