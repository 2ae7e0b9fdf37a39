// SPDX-License-Identifier: Apache-2.0
// Embree 3 or 4, whichever the build found, and owners for its handles.
#pragma once

#if VANTAGE_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstdlib>
#include <memory>
#include <string>
#include <type_traits>

#include "vantage/error.hpp"

namespace vantage::embree {

#if VANTAGE_EMBREE_MAJOR >= 4
using Context = RTCRayQueryContext;
#else
using Context = RTCIntersectContext;
#endif

struct Release {
  void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const noexcept { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Release>;

// Throws the device's pending error, if any. A null device reports the error of a failed rtcNewDevice.
inline void check(RTCDevice device, const std::string& doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(Errc::out_of_memory,
                "Embree has not enough memory while " + doing + "; use a smaller scene or a machine with more");
  throw Error(Errc::device_failure,
              "Embree failed while " + doing + " (error " + std::to_string(static_cast<int>(error)) + ")");
}

// Limits Embree's instruction set to AVX2, so that every x86-64 processor with AVX2 runs the same code of Embree.
// Processors without AVX2 use the best they have. The environment variable VANTAGE_EMBREE_ISA (sse2, sse4.2, avx, avx2,
// avx512) forces another, for tests and measurements.
inline std::string device_config() {
  const char* const forced = std::getenv("VANTAGE_EMBREE_ISA");
  return forced && *forced ? "isa=" + std::string(forced) : "max_isa=avx2";
}

// Returns one line about the instruction set, to compare results.
inline std::string told() {
  if (const char* const forced = std::getenv("VANTAGE_EMBREE_ISA"); forced && *forced)
    return "runs on every CPU; held to " + std::string(forced) + " by VANTAGE_EMBREE_ISA";
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    return "runs on every CPU; this one lacks AVX2, so that a ray at an edge may hit otherwise than on those that have "
           "it";
#endif
  return "runs on every CPU";
}

// Throws Error device_failure.
inline Device new_device() {
  const std::string config = device_config();
  Device device(rtcNewDevice(config.c_str()));
  if (!device) {
    check(nullptr, "creating its device with " + config);
    throw Error(Errc::device_failure, "Embree made no device and gave no reason");
  }
  return device;
}

// Traces one ray; callbacks get the address of `context`, which this call initialises.
inline void intersect(RTCScene scene, Context& context, RTCRayHit& hit) {
#if VANTAGE_EMBREE_MAJOR >= 4
  rtcInitRayQueryContext(&context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &hit, &arguments);
#else
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &hit);
#endif
}

// Makes a scene whose rays may start and end anywhere.
inline Scene new_scene(RTCDevice device) {
  Scene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

}  // namespace vantage::embree
