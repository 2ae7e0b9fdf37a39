// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/abilities.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "trace/vulkan/check.hpp"
#include "trace/vulkan/features.hpp"

namespace vantage::vulkan {
namespace {

std::vector<std::string> extensions_of(const InstanceFunctions& vk, VkPhysicalDevice device) {
  std::uint32_t count = 0;
  check(vk.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr),
        "vkEnumerateDeviceExtensionProperties");
  std::vector<VkExtensionProperties> properties(count);
  check(vk.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, properties.data()),
        "vkEnumerateDeviceExtensionProperties");
  std::vector<std::string> names;
  for (const auto& p : properties) names.emplace_back(p.extensionName);
  return names;
}

std::string join(const std::vector<std::string>& parts) {
  return std::accumulate(parts.begin(), parts.end(), std::string(), [](std::string all, const std::string& part) {
    return all.empty() ? part : std::move(all) + ", " + part;
  });
}

}  // namespace

const char* who_has(DeviceNeeds needs) {
  return needs == DeviceNeeds::ray_query
             ? "VK_KHR_ray_query: a GPU with ray tracing, or mesa-vulkan-drivers >= 24.1 for the "
               "software device"
             : "Vulkan 1.2";
}

std::string DeviceAbilities::refusal(DeviceNeeds needs) const {
  std::vector<std::string> lacks = compute_lacks;
  if (needs == DeviceNeeds::ray_query) lacks.insert(lacks.end(), ray_query_lacks.begin(), ray_query_lacks.end());
  if (lacks.empty()) return {};
  const bool newer_driver_has_it = software() && compute_lacks.empty();
  return "lacks " + join(lacks) + (newer_driver_has_it ? "; install mesa-vulkan-drivers >= 24.1" : "");
}

bool DeviceAbilities::better_than(const DeviceAbilities& other) const {
  const auto rank = [](const DeviceAbilities& x) {
    return x.type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU     ? 3
           : x.type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 2
           : x.software()                                     ? 0
                                                              : 1;
  };
  return rank(*this) != rank(other) ? rank(*this) > rank(other) : memory_bytes > other.memory_bytes;
}

DeviceMemory memory_of(const Instance& instance, VkPhysicalDevice device) {
  const InstanceFunctions& vk = instance.vk();
  const auto extensions = extensions_of(vk, device);
  const bool accounted = std::ranges::find(extensions, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME) != extensions.end();
  VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{};
  budget.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT;
  VkPhysicalDeviceMemoryProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2;
  properties.pNext = accounted ? &budget : nullptr;
  vk.vkGetPhysicalDeviceMemoryProperties2(device, &properties);
  DeviceMemory memory;
  for (std::uint32_t h = 0; h < properties.memoryProperties.memoryHeapCount; ++h) {
    const VkMemoryHeap& heap = properties.memoryProperties.memoryHeaps[h];
    if (!(heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)) continue;
    const std::uint64_t may = accounted ? budget.heapBudget[h] : heap.size, has = accounted ? budget.heapUsage[h] : 0;
    memory.used += has;
    memory.free = std::max<std::uint64_t>(memory.free, may > has ? may - has : 0);
  }
  return memory;
}

DeviceAbilities abilities_of(const Instance& instance, VkPhysicalDevice device) {
  const InstanceFunctions& vk = instance.vk();
  DeviceAbilities a;
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceSubgroupProperties subgroup{};
  subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  subgroup.pNext = &driver;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  vk.vkGetPhysicalDeviceProperties(device, &properties.properties);
  a.name = properties.properties.deviceName;
  a.type = properties.properties.deviceType;
  if (properties.properties.apiVersion < VK_API_VERSION_1_2) {
    a.compute_lacks.push_back("Vulkan 1.2 (the driver offers " +
                              std::to_string(VK_API_VERSION_MAJOR(properties.properties.apiVersion)) + "." +
                              std::to_string(VK_API_VERSION_MINOR(properties.properties.apiVersion)) + ")");
    return a;
  }
  properties.pNext = &subgroup;
  vk.vkGetPhysicalDeviceProperties2(device, &properties);
  a.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  a.subgroup_size = subgroup.subgroupSize;

  VkPhysicalDeviceMemoryProperties memory{};
  vk.vkGetPhysicalDeviceMemoryProperties(device, &memory);
  for (std::uint32_t h = 0; h < memory.memoryHeapCount; ++h)
    if (memory.memoryHeaps[h].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      a.memory_bytes = std::max<std::uint64_t>(a.memory_bytes, memory.memoryHeaps[h].size);

  std::uint32_t count = 0;
  vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  std::optional<std::uint32_t> family;
  for (std::uint32_t f = 0; f < count; ++f)
    if ((families[f].queueFlags & VK_QUEUE_COMPUTE_BIT) && families[f].timestampValidBits > 0 && !family) family = f;
  if (!family) a.compute_lacks.emplace_back("a compute queue with timestamps");
  a.queue_family = family.value_or(0);

  const auto extensions = extensions_of(vk, device);
  const auto has = [&](const char* name) {
    return std::find(extensions.begin(), extensions.end(), name) != extensions.end();
  };
  bool all_ray_query = true;
  for (const char* name : kRayQueryExtensions)
    if (!has(name)) {
      a.ray_query_lacks.emplace_back(name);
      all_ray_query = false;
    }
  Features features(all_ray_query);
  vk.vkGetPhysicalDeviceFeatures2(device, &features.core);
  const auto need = [](bool present, const char* name, std::vector<std::string>& lacks) {
    if (!present) lacks.emplace_back(name);
  };
  need(features.v12.bufferDeviceAddress, "bufferDeviceAddress", a.compute_lacks);
  need(features.v12.scalarBlockLayout, "scalarBlockLayout", a.compute_lacks);
  need(features.core.features.shaderInt64, "shaderInt64", a.compute_lacks);
  const VkSubgroupFeatureFlags subgroup_needs =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
  need((subgroup.supportedOperations & subgroup_needs) == subgroup_needs &&
           (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT),
       "subgroup arithmetic and ballot in compute shaders", a.compute_lacks);
  if (all_ray_query) {
    need(features.acceleration.accelerationStructure, "accelerationStructure", a.ray_query_lacks);
    need(features.ray_query.rayQuery, "rayQuery", a.ray_query_lacks);
  }
  return a;
}

}  // namespace vantage::vulkan
