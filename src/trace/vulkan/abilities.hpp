// SPDX-License-Identifier: Apache-2.0
// Abilities of a physical device that engines need.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trace/vulkan/instance.hpp"

namespace vantage::vulkan {

// Requirements of an engine on a device.
enum class DeviceNeeds {
  compute,    // Vulkan 1.2 with addresses, 64-bit integers and subgroups
  ray_query,  // VK_KHR_ray_query as well
};
// Returns a description of devices that meet them, for messages.
const char* who_has(DeviceNeeds needs);

struct DeviceAbilities {
  std::string name, driver;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  std::uint32_t queue_family = 0;
  std::uint32_t subgroup_size = 1;
  std::uint64_t memory_bytes = 0;            // largest device-local heap
  std::vector<std::string> compute_lacks;    // reasons why no engine runs on it
  std::vector<std::string> ray_query_lacks;  // further reasons why no engine with ray queries runs on it
  bool software() const { return type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  // Returns why an engine with these needs does not run on it, and what helps; empty if it runs.
  std::string refusal(DeviceNeeds needs) const;
  // Prefers hardware to software, discrete to integrated devices, then the most memory.
  bool better_than(const DeviceAbilities& other) const;
};
// Memory of this process in bytes. If the driver keeps no account (VK_EXT_memory_budget), all memory counts as
// free.
struct DeviceMemory {
  std::uint64_t used = 0;  // in all device-local heaps
  std::uint64_t free = 0;  // in the device-local heap with most free memory
};
DeviceMemory memory_of(const Instance& instance, VkPhysicalDevice device);
DeviceAbilities abilities_of(const Instance& instance, VkPhysicalDevice device);

}  // namespace vantage::vulkan
