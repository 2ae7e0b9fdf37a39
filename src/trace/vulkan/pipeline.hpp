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

class ComputePipeline {
 public:
  ComputePipeline() = default;
  struct Constant {
    std::uint32_t id, value;
  };
  ComputePipeline(const Device& device, const std::uint32_t* words, std::size_t size_in_bytes, std::uint32_t push_bytes,
                  std::span<const Constant> constants, const TraceSet& set, const char* name);

  void bind(VkCommandBuffer commands, const void* push) const;
  template <class Push>
  void dispatch(VkCommandBuffer commands, const Push& push, std::uint32_t x, std::uint32_t y = 1,
                std::uint32_t z = 1) const {
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= 128);  // 128 bytes is what every device has
    bind(commands, &push);
    vkCmdDispatch(commands, x, y, z);
  }
  explicit operator bool() const { return static_cast<bool>(pipeline_); }

 private:
  std::uint32_t push_bytes_ = 0;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
};

}  // namespace vantage::vulkan
