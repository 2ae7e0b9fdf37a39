// SPDX-License-Identifier: Apache-2.0
// The smallest Vulkan engine: every ray against every triangle. It shows how little a user's own engine needs, and that
// the suite works for an engine known only to this folder.
#pragma once

#include "trace/vulkan/traversal.hpp"

namespace vantage::test {

extern const vulkan::VulkanEngine brute_force_engine;

}  // namespace vantage::test
