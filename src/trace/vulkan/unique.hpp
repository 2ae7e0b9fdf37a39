// SPDX-License-Identifier: Apache-2.0
// Sole owner of one Vulkan handle of a device.
#pragma once

#include <volk.h>

#include <utility>

namespace vantage::vulkan {

// `destroy` points at the variable that volk fills with the function, since it is not known at compile time.
template <class Handle, auto destroy>
class Unique {
 public:
  Unique() = default;
  Unique(VkDevice device, Handle handle) : device_(device), handle_(handle) {}
  Unique(Unique&& other) noexcept : device_(other.device_), handle_(std::exchange(other.handle_, Handle{})) {}
  Unique& operator=(Unique&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Unique() {
    if (handle_) (*destroy)(device_, handle_, nullptr);
  }
  Handle get() const { return handle_; }
  explicit operator bool() const { return handle_ != Handle{}; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  Handle handle_ = Handle{};
};

using UniquePipeline = Unique<VkPipeline, &vkDestroyPipeline>;
using UniquePipelineLayout = Unique<VkPipelineLayout, &vkDestroyPipelineLayout>;
using UniqueSetLayout = Unique<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout>;
using UniqueDescriptorPool = Unique<VkDescriptorPool, &vkDestroyDescriptorPool>;
using UniqueShaderModule = Unique<VkShaderModule, &vkDestroyShaderModule>;
using UniqueBuffer = Unique<VkBuffer, &vkDestroyBuffer>;
using UniqueMemory = Unique<VkDeviceMemory, &vkFreeMemory>;
using UniqueCommandPool = Unique<VkCommandPool, &vkDestroyCommandPool>;
using UniqueFence = Unique<VkFence, &vkDestroyFence>;
using UniqueQueryPool = Unique<VkQueryPool, &vkDestroyQueryPool>;
using UniqueAccelerationStructure = Unique<VkAccelerationStructureKHR, &vkDestroyAccelerationStructureKHR>;

}  // namespace vantage::vulkan
