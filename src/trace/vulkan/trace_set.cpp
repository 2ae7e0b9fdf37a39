// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/trace_set.hpp"

#include <array>

#include "trace/vulkan/check.hpp"

namespace vantage::vulkan {

TraceSet::TraceSet(const Device& device, const Buffer& parameters, VkAccelerationStructureKHR structure) {
  const std::uint32_t count = structure ? 2 : 1;
  const std::array<VkDescriptorSetLayoutBinding, 2> bindings{
      {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
       {1, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}}};
  VkDescriptorSetLayoutCreateInfo layout_info{};
  layout_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  layout_info.bindingCount = count;
  layout_info.pBindings = bindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(device.vk().vkCreateDescriptorSetLayout(device.handle(), &layout_info, nullptr, &layout),
        "vkCreateDescriptorSetLayout");
  layout_ = UniqueSetLayout(device, layout);
  const std::array<VkDescriptorPoolSize, 2> sizes{
      {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1}, {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1}}};
  VkDescriptorPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = count;
  pool_info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(device.vk().vkCreateDescriptorPool(device.handle(), &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
  pool_ = UniqueDescriptorPool(device, pool);
  VkDescriptorSetAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  allocate.descriptorPool = pool;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &layout;
  check(device.vk().vkAllocateDescriptorSets(device.handle(), &allocate, &set_), "vkAllocateDescriptorSets");

  const VkDescriptorBufferInfo buffer{parameters.handle(), 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSetAccelerationStructureKHR structures{};
  structures.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
  structures.accelerationStructureCount = 1;
  structures.pAccelerationStructures = &structure;
  std::array<VkWriteDescriptorSet, 2> writes{};
  for (std::uint32_t k = 0; k < count; ++k) {
    writes[k].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[k].dstSet = set_;
    writes[k].dstBinding = k;
    writes[k].descriptorCount = 1;
    writes[k].descriptorType = bindings[k].descriptorType;
  }
  writes[0].pBufferInfo = &buffer;
  writes[1].pNext = &structures;
  device.vk().vkUpdateDescriptorSets(device.handle(), count, writes.data(), 0, nullptr);
}

}  // namespace vantage::vulkan
