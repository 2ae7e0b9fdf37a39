// SPDX-License-Identifier: Apache-2.0
// A compute pipeline: one embedded shader, its specialization constants, a push-constant block, and the descriptor set
// of all kernels.
#pragma once

#include <cstdint>
#include <span>

#include "trace/vulkan/device.hpp"
#include "trace/vulkan/trace_set.hpp"
#include "trace/vulkan/unique.hpp"

namespace vantage::vulkan {

using Shader = std::span<const std::uint32_t>;  // SPIR-V

class ComputePipeline {
 public:
  ComputePipeline() = default;
  struct Constant {
    std::uint32_t id, value;
  };
  ComputePipeline(const Device& device, Shader shader, std::uint32_t push_bytes, std::span<const Constant> constants,
                  const TraceSet& set, const char* name);

  void bind(const VolkDeviceTable& vk, VkCommandBuffer commands, const void* push) const;
  explicit operator bool() const { return static_cast<bool>(pipeline_); }

 private:
  std::uint32_t push_bytes_ = 0;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
};

}  // namespace vantage::vulkan
