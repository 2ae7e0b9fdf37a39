// SPDX-License-Identifier: Apache-2.0
// A Vulkan instance with its own functions, and its validation layer's messages.
#pragma once

#include <volk.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace vantage::vulkan {

// clang-format off
// The last three exist with validation only.
#define VANTAGE_INSTANCE_FUNCTIONS(use) \
  use(vkDestroyInstance) \
  use(vkEnumeratePhysicalDevices) \
  use(vkEnumerateDeviceExtensionProperties) \
  use(vkGetPhysicalDeviceProperties) \
  use(vkGetPhysicalDeviceProperties2) \
  use(vkGetPhysicalDeviceFeatures2) \
  use(vkGetPhysicalDeviceMemoryProperties) \
  use(vkGetPhysicalDeviceMemoryProperties2) \
  use(vkGetPhysicalDeviceQueueFamilyProperties) \
  use(vkCreateDevice) \
  use(vkGetDeviceProcAddr) \
  use(vkCreateDebugUtilsMessengerEXT) \
  use(vkDestroyDebugUtilsMessengerEXT) \
  use(vkSetDebugUtilsObjectNameEXT)
// clang-format on

// Functions of one instance. volk's global table holds those of the instance loaded last, with null for any that it
// lacks; therefore nothing here loads it, and each instance and each device keeps its own table.
struct InstanceFunctions {
#define VANTAGE_FUNCTION(name) PFN_##name name = nullptr;
  VANTAGE_INSTANCE_FUNCTIONS(VANTAGE_FUNCTION)
#undef VANTAGE_FUNCTION
};

class Instance {
 public:
  // Returns the process's instance, with or without the validation layer; all holders share it. Throws as the
  // constructor.
  static std::shared_ptr<Instance> get(bool validation);

  // Throws Error no_suitable_device if there is no Vulkan loader, or no validation layer although requested.
  explicit Instance(bool validation);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  const InstanceFunctions& vk() const { return vk_; }
  std::vector<VkPhysicalDevice> physical_devices() const;
  // Functions of one of its devices.
  VolkDeviceTable functions_of(VkDevice device) const;
  // Throws Error device_failure with the validation layer's reports since the last call.
  void check_validation();

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                   VkDebugUtilsMessageTypeFlagsEXT,
                                                   const VkDebugUtilsMessengerCallbackDataEXT*, void*);
  VkInstance instance_ = VK_NULL_HANDLE;
  InstanceFunctions vk_;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::mutex mutex_;
  std::vector<std::string> messages_;
};

}  // namespace vantage::vulkan
