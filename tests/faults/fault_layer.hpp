// SPDX-License-Identifier: Apache-2.0
// What a test tells the Vulkan layer beside it, and is told by it (fault_layer.cpp). The layer is loaded by the Vulkan
// loader; a test opens the same file and asks for `vantage_fault_layer`.
#pragma once

#include <cstdint>

namespace vantage::test {

enum class Fault {
  none,
  lost,           // from this call on the device is lost: what may say so does, until it is destroyed
  gone,           // and so is every device that is made from then on
  device_memory,  // this call says VK_ERROR_OUT_OF_DEVICE_MEMORY
  host_memory,    // this call says VK_ERROR_OUT_OF_HOST_MEMORY
  timeout,        // this wait says VK_TIMEOUT, before the time is over
  hang,           // this wait and all after it do
  late,           // this call takes a fifth of a second longer
};

struct FaultControl {
  // Counts begin at 0, and the call number `call` of those that the fault can befall meets it.
  void (*arm)(Fault fault, std::uint64_t call);
  // How many calls there were since that the fault could have befallen.
  std::uint64_t (*calls)(Fault fault);
  const char* (*struck)();  // the call that met the fault; null: none did
  // Memory of the devices, all together: what may be allocated at most, 0 for all there is, and what was at most since
  // arm().
  void (*limit)(std::uint64_t bytes);
  std::uint64_t (*peak_bytes)();
  // By how much longer than it took the device says that work took.
  void (*slow_down)(double factor);
  std::uint64_t (*dispatches)();  // since arm()
  // Objects of devices, and devices, that were made and not destroyed.
  std::int64_t (*alive)();
};

using GetFaultControl = const FaultControl* (*)();

}  // namespace vantage::test
