// SPDX-License-Identifier: Apache-2.0
// Embree 3 or 4, whichever the build found, and owners for its handles.
#pragma once

#if VANTAGE_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <string>
#include <type_traits>

#include "vantage/error.hpp"

namespace vantage::embree {

struct Release {
  void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const noexcept { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Release>;

// Throws the device's pending error, if it has one; a null device asks for the error of a failed rtcNewDevice.
inline void check(RTCDevice device, const std::string& doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(Errc::out_of_memory,
                "Embree has not enough memory while " + doing + "; use a smaller scene or a machine with more");
  throw Error(Errc::device_failure,
              "Embree failed while " + doing + " (error " + std::to_string(static_cast<int>(error)) + ")");
}

// Throws Error device_failure.
inline Device new_device(const char* config = nullptr) {
  Device device(rtcNewDevice(config));
  if (!device) {
    check(nullptr, "creating its device");
    throw Error(Errc::device_failure, "Embree made no device and gave no reason");
  }
  return device;
}

}  // namespace vantage::embree
