// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/check.hpp"

#include <string>

#include "trace/device_fault.hpp"

namespace vantage::vulkan {

void check(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  const std::string where = std::string(" in ") + what + " (VkResult " + std::to_string(result) + ")";
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      throw DeviceFault(Errc::out_of_memory,
                        "the host ran out of memory" + where + "; use a larger voxel or a smaller scene");
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      throw DeviceFault(Errc::out_of_memory, "the Vulkan device ran out of memory" + where +
                                                 "; use a larger voxel, a smaller scene, or the engine embree");
    case VK_ERROR_DEVICE_LOST:
      throw DeviceFault(Errc::device_failure,
                        "the Vulkan device was lost" + where + "; its driver reset it or it was unplugged");
    default: throw DeviceFault(Errc::device_failure, "the Vulkan device failed" + where);
  }
}

}  // namespace vantage::vulkan
