// SPDX-License-Identifier: Apache-2.0
// The descriptor set that a scanner has for all kernels: its block of parameters, and where rays are queried the
// acceleration structure. All have the same layout.
#pragma once

#include "trace/vulkan/buffer.hpp"
#include "trace/vulkan/unique.hpp"

namespace vantage::vulkan {

class TraceSet {
 public:
  // `structure` may be null. Both arguments must outlive the set's use.
  TraceSet(const Device& device, const Buffer& parameters, VkAccelerationStructureKHR structure);

  VkDescriptorSetLayout layout() const { return layout_.get(); }
  VkDescriptorSet handle() const { return set_; }

 private:
  UniqueSetLayout layout_;
  UniqueDescriptorPool pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace vantage::vulkan
