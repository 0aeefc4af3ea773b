#include "trace/embree_version.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace relook {

std::string embree_version() {
  RTCDevice device = rtcNewDevice(nullptr);  // only a device has properties; without scenes it starts no thread
  if (device == nullptr) return "none";
  const auto part = [&](RTCDeviceProperty property) { return std::to_string(rtcGetDeviceProperty(device, property)); };
  const std::string version = part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
                              "." + part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
  rtcReleaseDevice(device);
  return version;
}

}  // namespace relook
