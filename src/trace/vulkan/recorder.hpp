// SPDX-License-Identifier: Apache-2.0
// Records commands into a command buffer.
#pragma once

#include <type_traits>

#include "trace/vulkan/buffer.hpp"
#include "trace/vulkan/pipeline.hpp"

namespace vantage::vulkan {

class Recorder {
 public:
  Recorder(const VolkDeviceTable& vk, VkCommandBuffer commands) : vk_(vk), commands_(commands) {}

  void zero(const Buffer& buffer, VkDeviceSize offset = 0, VkDeviceSize bytes = VK_WHOLE_SIZE) const;
  // Writes `data` to the front of a buffer. Meant for small arrays, as their bytes are part of the command.
  void update(const Buffer& buffer, const void* data, VkDeviceSize bytes) const;
  void copy(const Buffer& from, const Buffer& to, const VkBufferCopy& region) const;
  void build(const VkAccelerationStructureBuildGeometryInfoKHR& info,
             const VkAccelerationStructureBuildRangeInfoKHR& range) const;

  // Dispatches a kernel with the given number of workgroups, or with the three words that `groups` holds at `offset` at
  // execution.
  template <class Push>
  void dispatch(const BoundPipeline& pipeline, const Push& push, std::uint32_t x, std::uint32_t y = 1,
                std::uint32_t z = 1) const {
    bind(pipeline, push);
    vk_.vkCmdDispatch(commands_, x, y, z);
  }
  template <class Push>
  void dispatch_indirect(const BoundPipeline& pipeline, const Push& push, const Buffer& groups,
                         VkDeviceSize offset) const {
    bind(pipeline, push);
    vk_.vkCmdDispatchIndirect(commands_, groups.handle(), offset);
  }

  // Barriers.
  void shader_after_transfer() const;  // shaders and indirect dispatches see earlier fills and copies
  void shader_after_shader() const;    // shaders, indirect dispatches and copies see earlier shaders' writes
  void anyone_after_anyone() const;    // the host and the next submission see all writes

 private:
  template <class Push>
  void bind(const BoundPipeline& pipeline, const Push& push) const {
    // 128 bytes are guaranteed on every device
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= 128);
    pipeline.pipeline->bind(vk_, commands_, pipeline.set, &push);
  }
  void barrier(VkPipelineStageFlags from_stage, VkAccessFlags from, VkPipelineStageFlags to_stage,
               VkAccessFlags to) const;

  const VolkDeviceTable& vk_;
  VkCommandBuffer commands_;
};

}  // namespace vantage::vulkan
