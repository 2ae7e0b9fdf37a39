// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/buffer.hpp"

#include <algorithm>

#include "trace/vulkan/check.hpp"

namespace vantage::vulkan {

Buffer::Buffer(const Device& device, VkDeviceSize size, Where where, const char* name, VkBufferUsageFlags extra)
    : size_(std::max<VkDeviceSize>(size, 16)) {
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = size_;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | extra;
  VkBuffer buffer = VK_NULL_HANDLE;
  check(device.vk().vkCreateBuffer(device.handle(), &info, nullptr, &buffer), name);
  buffer_ = UniqueBuffer(device, buffer);
  device.name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer), name);

  VkMemoryRequirements requirements{};
  device.vk().vkGetBufferMemoryRequirements(device.handle(), buffer, &requirements);
  constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkMemoryPropertyFlags wanted = kVisible;
  if (where == Where::device) wanted = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  // Reading from uncached memory is slow; most devices offer a cached kind.
  if (where == Where::download && device.has_memory_type(kVisible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT))
    wanted |= VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  VkMemoryAllocateFlagsInfo flags{};
  flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocate.pNext = &flags;
  allocate.allocationSize = requirements.size;
  allocate.memoryTypeIndex = device.memory_type(requirements.memoryTypeBits, wanted);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(device.vk().vkAllocateMemory(device.handle(), &allocate, nullptr, &memory), name);
  memory_ = UniqueMemory(device, memory);
  check(device.vk().vkBindBufferMemory(device.handle(), buffer, memory, 0), name);
  if (where != Where::device)
    check(device.vk().vkMapMemory(device.handle(), memory, 0, VK_WHOLE_SIZE, 0, &mapped_), name);

  VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, buffer};
  address_ = device.vk().vkGetBufferDeviceAddress(device.handle(), &address);
}

}  // namespace vantage::vulkan
