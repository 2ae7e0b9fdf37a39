// SPDX-License-Identifier: Apache-2.0
// The only place that turns a VkResult into an exception.
#pragma once

#include <volk.h>

namespace vantage::vulkan {

// Throws DeviceFault: out_of_memory, device_failure. `what` names the call for the message.
void check(VkResult result, const char* what);

}  // namespace vantage::vulkan
