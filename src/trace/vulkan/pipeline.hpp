// SPDX-License-Identifier: Apache-2.0
// A compute pipeline: one embedded shader, its specialization constants, a push-constant block, and the common layout
// of descriptor sets.
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
  struct Constant {
    std::uint32_t id, value;
  };
  ComputePipeline(const Device& device, Shader shader, std::uint32_t push_bytes, std::span<const Constant> constants,
                  const TraceSet& set, const char* name);  // `set`: for its layout

  void bind(const VolkDeviceTable& vk, VkCommandBuffer commands, VkDescriptorSet set, const void* push) const;

 private:
  std::uint32_t push_bytes_ = 0;
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
};

// A pipeline with a scanner's set, ready for dispatch.
struct BoundPipeline {
  const ComputePipeline* pipeline;
  VkDescriptorSet set;
};

}  // namespace vantage::vulkan
