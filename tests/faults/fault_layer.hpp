// SPDX-License-Identifier: Apache-2.0
// Interface between a test and its Vulkan layer (fault_layer.cpp). The Vulkan loader loads the layer; a test opens the
// same file and looks up `vantage_fault_layer`.
#pragma once

#include <cstdint>

namespace vantage::test {

enum class Fault {
  none,
  lost,           // from this call on the device is lost: calls that may say so do, until it is destroyed
  gone,           // and so is every device made from then on
  device_memory,  // this call returns VK_ERROR_OUT_OF_DEVICE_MEMORY
  host_memory,    // this call returns VK_ERROR_OUT_OF_HOST_MEMORY
  timeout,        // this wait returns VK_TIMEOUT, before its time is over
  hang,           // this wait and all later ones do
  late,           // this call takes a fifth of a second longer
};

struct FaultControl {
  // Resets counts to 0; the fault meets call number `call` of those that can fail that way.
  void (*arm)(Fault fault, std::uint64_t call);
  // Number of calls since then that could have met the fault.
  std::uint64_t (*calls)(Fault fault);
  const char* (*struck)();  // the call that met the fault; null: none
  // Memory of all devices together: the allocation limit, 0 for none, and the peak since arm().
  void (*limit)(std::uint64_t bytes);
  std::uint64_t (*peak_bytes)();
  // Factor by which the device's reported times are multiplied.
  void (*slow_down)(double factor);
  std::uint64_t (*dispatches)();  // since arm()
  // Device objects, and devices, made and not destroyed.
  std::int64_t (*alive)();
};

using GetFaultControl = const FaultControl* (*)();

}  // namespace vantage::test
