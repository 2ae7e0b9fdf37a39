// SPDX-License-Identifier: Apache-2.0
// A compute pipeline: one embedded shader, its specialization constants, a push-constant block, and where rays are queried
// the acceleration structure as its only descriptor.
#pragma once

#include <cstdint>
#include <span>

#include "trace/vulkan/device.hpp"
#include "trace/vulkan/unique.hpp"

namespace vantage::vulkan {

class ComputePipeline {
 public:
  ComputePipeline() = default;
  // `constants[k]` becomes the specialization constant with constant_id k (32 bits each).
  ComputePipeline(const Device& device, const std::uint32_t* words, std::size_t size_in_bytes, std::uint32_t push_bytes,
                  std::span<const std::uint32_t> constants, VkDescriptorSetLayout set_layout, const char* name);

  void bind(VkCommandBuffer commands, const void* push, VkDescriptorSet set) const;
  template <class Push>
  void dispatch(VkCommandBuffer commands, const Push& push, VkDescriptorSet set, std::uint32_t x, std::uint32_t y = 1, std::uint32_t z = 1) const {
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= 128);  // 128 bytes is what every device has
    bind(commands, &push, set);
    vkCmdDispatch(commands, x, y, z);
  }
  explicit operator bool() const { return static_cast<bool>(pipeline_); }

 private:
  std::uint32_t push_bytes_ = 0;
  UniquePipelineLayout layout_;
  UniquePipeline pipeline_;
};

}  // namespace vantage::vulkan
