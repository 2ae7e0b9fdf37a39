// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/recorder.hpp"

#include <algorithm>
#include <cstddef>

namespace vantage::vulkan {

void Recorder::zero(const Buffer& buffer, VkDeviceSize offset, VkDeviceSize bytes) const {
  vk_.vkCmdFillBuffer(commands_, buffer.handle(), offset, bytes, 0);
}

void Recorder::update(const Buffer& buffer, const void* data, VkDeviceSize bytes) const {
  constexpr VkDeviceSize kMostBytes = 65536;  // limit of one command
  for (VkDeviceSize done = 0; done < bytes; done += kMostBytes)
    vk_.vkCmdUpdateBuffer(commands_, buffer.handle(), done, std::min(kMostBytes, bytes - done),
                          static_cast<const std::byte*>(data) + done);
}

void Recorder::copy(const Buffer& from, const Buffer& to, const VkBufferCopy& region) const {
  vk_.vkCmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &region);
}

void Recorder::build(const VkAccelerationStructureBuildGeometryInfoKHR& info,
                     const VkAccelerationStructureBuildRangeInfoKHR& range) const {
  const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
  vk_.vkCmdBuildAccelerationStructuresKHR(commands_, 1, &info, &ranges);
}

void Recorder::shader_after_transfer() const {
  barrier(VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
          VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

void Recorder::shader_after_shader() const {
  barrier(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
          VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT |
              VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
}

void Recorder::anyone_after_anyone() const {
  barrier(VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
          VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
          VK_ACCESS_HOST_READ_BIT | VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
}

void Recorder::barrier(VkPipelineStageFlags from_stage, VkAccessFlags from, VkPipelineStageFlags to_stage,
                       VkAccessFlags to) const {
  const VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, from, to};
  vk_.vkCmdPipelineBarrier(commands_, from_stage, to_stage, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

}  // namespace vantage::vulkan
