// Embree's device: what is made with it, released when nobody holds it any more, and what went wrong, as our own
// errors. Embree is C to us: nothing is thrown through it. Beside this only tracer.cpp and embree_version.cpp
// see Embree, 3 or 4.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <exception>
#include <memory>
#include <mutex>

#include "trace/tracer.h"

namespace relook {

struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using SceneHandle = std::unique_ptr<RTCSceneTy, ReleaseScene>;
using GeometryHandle = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;

class EmbreeDevice {
 public:
  /// Throws std::bad_alloc.
  explicit EmbreeDevice(MemoryMonitor monitor);
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  [[nodiscard]] SceneHandle new_scene();
  [[nodiscard]] GeometryHandle new_geometry(RTCGeometryType type);

  /// After building: Embree reports what went wrong only on request, and leaves its own float mode behind. Throws what
  /// the monitor has thrown, std::bad_alloc or ResourceError.
  void check();

 private:
  static bool report_memory(void* device, ssize_t bytes, bool is_done);
  /// What Embree has made, if it has.
  template <class Handle>
  Handle checked(Handle handle);

  MemoryMonitor monitor_;
  RTCDevice device_ = nullptr;
  std::mutex mutex_;
  std::exception_ptr thrown_;  // by the monitor, since the last check()
};

}  // namespace relook
