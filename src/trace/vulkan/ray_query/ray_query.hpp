// SPDX-License-Identifier: Apache-2.0
// The engine ray_query: the driver's acceleration structure, traversed by VK_KHR_ray_query.
#pragma once

#include "trace/vulkan/traversal.hpp"

namespace vantage::vulkan {

extern const VulkanEngine ray_query_engine;

}  // namespace vantage::vulkan
