// SPDX-License-Identifier: Apache-2.0
// The Vulkan instance, which devices there are and what each can do, and the logical device that an engine works on.
#pragma once

#include <volk.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "vantage/trace.hpp"

namespace vantage::vulkan {

// The process's instance, shared by all who hold one. Collects what the validation layer says.
class Instance {
 public:
  // Throws Error no_suitable_device where there is no Vulkan loader, or no validation layer though one is asked for.
  static std::shared_ptr<Instance> get(bool validation);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return instance_; }
  std::vector<VkPhysicalDevice> physical_devices() const;
  // Throws Error device_failure with what the validation layer reported since the last call.
  void check_validation();

 private:
  explicit Instance(bool validation);
  static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                   VkDebugUtilsMessageTypeFlagsEXT,
                                                   const VkDebugUtilsMessengerCallbackDataEXT*, void*);
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::mutex mutex_;
  std::vector<std::string> messages_;
};

// What a physical device offers that the engines ask for.
struct DeviceAbilities {
  std::string name, driver;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  std::uint32_t queue_family = 0;
  std::uint32_t subgroup_size = 1;
  std::uint64_t memory_bytes = 0;            // largest device-local heap
  std::vector<std::string> compute_lacks;    // why no engine runs on it; empty: compute_bvh runs
  std::vector<std::string> ray_query_lacks;  // why ray_query does not, beyond compute_lacks
  bool software() const { return type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
};
DeviceAbilities abilities_of(VkPhysicalDevice device);

// A logical device with one compute queue.
class Device {
 public:
  // REQUIRES: nothing lacking for what is asked.
  Device(std::shared_ptr<Instance> instance, VkPhysicalDevice physical, const DeviceAbilities& abilities,
         bool ray_query);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle() const { return device_; }
  VkQueue queue() const { return queue_; }
  const DeviceAbilities& abilities() const { return abilities_; }
  Instance& instance() const { return *instance_; }
  bool ray_query() const { return ray_query_; }
  std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;  // throws Error out_of_memory
  bool has_memory_type(VkMemoryPropertyFlags wanted) const;
  VkDeviceSize scratch_alignment() const { return scratch_alignment_; }
  double timestamp_period_ns() const { return timestamp_period_ns_; }
  void name(VkObjectType type, std::uint64_t handle, const char* name) const;  // for debuggers and validation messages

 private:
  std::shared_ptr<Instance> instance_;
  DeviceAbilities abilities_;
  bool ray_query_;
  VkPhysicalDeviceMemoryProperties memory_{};
  VkDeviceSize scratch_alignment_ = 1;
  double timestamp_period_ns_ = 1;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
};

}  // namespace vantage::vulkan
