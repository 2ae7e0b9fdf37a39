// SPDX-License-Identifier: Apache-2.0
// The smallest Vulkan engine: every ray against every triangle. It shows how little an engine of one's own takes, and
// that the suite holds for one that nothing but this folder knows.
#pragma once

#include "trace/vulkan/traversal.hpp"

namespace vantage::test {

extern const vulkan::VulkanEngine brute_force_engine;

}  // namespace vantage::test
