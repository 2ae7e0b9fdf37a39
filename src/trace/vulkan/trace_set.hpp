// SPDX-License-Identifier: Apache-2.0
// A scanner's descriptor set, common to all kernels: its parameter block and, for ray queries, the acceleration
// structure. All sets have the same layout.
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
