// SPDX-License-Identifier: Apache-2.0
// Sole owner of one Vulkan handle of a device.
#pragma once

#include <utility>

#include "trace/vulkan/device.hpp"

namespace vantage::vulkan {

// `destroy` names the function in the device's table.
template <class Handle, auto destroy>
class Unique {
 public:
  Unique() = default;
  Unique(const Device& device, Handle handle) : device_(&device), handle_(handle) {}
  Unique(Unique&& other) noexcept : device_(other.device_), handle_(std::exchange(other.handle_, Handle{})) {}
  Unique& operator=(Unique&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Unique() {
    if (handle_ && !device_->given_up()) (device_->vk().*destroy)(device_->handle(), handle_, nullptr);
  }
  Handle get() const { return handle_; }
  explicit operator bool() const { return handle_ != Handle{}; }

 private:
  const Device* device_ = nullptr;
  Handle handle_ = Handle{};
};

using UniquePipeline = Unique<VkPipeline, &VolkDeviceTable::vkDestroyPipeline>;
using UniquePipelineLayout = Unique<VkPipelineLayout, &VolkDeviceTable::vkDestroyPipelineLayout>;
using UniqueSetLayout = Unique<VkDescriptorSetLayout, &VolkDeviceTable::vkDestroyDescriptorSetLayout>;
using UniqueDescriptorPool = Unique<VkDescriptorPool, &VolkDeviceTable::vkDestroyDescriptorPool>;
using UniqueShaderModule = Unique<VkShaderModule, &VolkDeviceTable::vkDestroyShaderModule>;
using UniqueBuffer = Unique<VkBuffer, &VolkDeviceTable::vkDestroyBuffer>;
using UniqueMemory = Unique<VkDeviceMemory, &VolkDeviceTable::vkFreeMemory>;
using UniqueCommandPool = Unique<VkCommandPool, &VolkDeviceTable::vkDestroyCommandPool>;
using UniqueFence = Unique<VkFence, &VolkDeviceTable::vkDestroyFence>;
using UniqueQueryPool = Unique<VkQueryPool, &VolkDeviceTable::vkDestroyQueryPool>;
using UniqueAccelerationStructure =
    Unique<VkAccelerationStructureKHR, &VolkDeviceTable::vkDestroyAccelerationStructureKHR>;

}  // namespace vantage::vulkan
