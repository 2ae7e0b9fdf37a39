// SPDX-License-Identifier: Apache-2.0
// The engine compute_bvh: our own BVH, traversed by a compute shader.
#pragma once

#include "trace/vulkan/traversal.hpp"

namespace vantage::vulkan {

extern const VulkanEngine compute_bvh_engine;

}  // namespace vantage::vulkan
