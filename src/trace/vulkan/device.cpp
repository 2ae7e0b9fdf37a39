// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/device.hpp"

#include <algorithm>

#include "trace/vulkan/check.hpp"
#include "trace/vulkan/features.hpp"
#include "vantage/error.hpp"

namespace vantage::vulkan {

Device::Device(std::shared_ptr<Instance> instance, VkPhysicalDevice physical, const DeviceAbilities& abilities,
               DeviceNeeds needs)
    : instance_(std::move(instance)), abilities_(abilities) {
  const InstanceFunctions& vk = instance_->vk();
  const bool ray_query = needs == DeviceNeeds::ray_query;
  vk.vkGetPhysicalDeviceMemoryProperties(physical, &memory_);
  VkPhysicalDeviceAccelerationStructurePropertiesKHR acceleration{};
  acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = ray_query ? &acceleration : nullptr;
  vk.vkGetPhysicalDeviceProperties2(physical, &properties);
  timestamp_period_ns_ = static_cast<double>(properties.properties.limits.timestampPeriod);
  if (ray_query)
    scratch_alignment_ = std::max<VkDeviceSize>(1, acceleration.minAccelerationStructureScratchOffsetAlignment);

  Features features(ray_query);
  features.core.features.shaderInt64 = VK_TRUE;
  features.v12.bufferDeviceAddress = VK_TRUE;
  features.v12.scalarBlockLayout = VK_TRUE;
  features.acceleration.accelerationStructure = VK_TRUE;
  features.ray_query.rayQuery = VK_TRUE;

  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = abilities.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features.core;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  if (ray_query) {
    info.enabledExtensionCount = static_cast<std::uint32_t>(kRayQueryExtensions.size());
    info.ppEnabledExtensionNames = kRayQueryExtensions.data();
  }
  check(vk.vkCreateDevice(physical, &info, nullptr, &device_), "vkCreateDevice");
  vk_ = instance_->functions_of(device_);
  vk_.vkGetDeviceQueue(device_, abilities.queue_family, 0, &queue_);
}

Device::~Device() {
  if (given_up_) return;
  vk_.vkDeviceWaitIdle(device_);
  vk_.vkDestroyDevice(device_, nullptr);
}

bool Device::has_memory_type(VkMemoryPropertyFlags wanted) const {
  for (std::uint32_t t = 0; t < memory_.memoryTypeCount; ++t)
    if ((memory_.memoryTypes[t].propertyFlags & wanted) == wanted) return true;
  return false;
}

std::uint32_t Device::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
  for (std::uint32_t t = 0; t < memory_.memoryTypeCount; ++t)
    if ((allowed & (1u << t)) && (memory_.memoryTypes[t].propertyFlags & wanted) == wanted) return t;
  throw Error(Errc::out_of_memory,
              "the Vulkan device " + abilities_.name + " has no memory of the kind that a buffer needs");
}

void Device::name(VkObjectType type, std::uint64_t handle, const char* name) const {
  const auto set_name = instance_->vk().vkSetDebugUtilsObjectNameEXT;
  if (!set_name) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type, handle, name};
  set_name(device_, &info);
}

}  // namespace vantage::vulkan
