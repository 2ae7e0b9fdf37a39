// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/pipeline.hpp"

#include <cstddef>
#include <vector>

#include "trace/vulkan/check.hpp"

namespace vantage::vulkan {

ComputePipeline::ComputePipeline(const Device& device, Shader shader, std::uint32_t push_bytes,
                                 std::span<const Constant> constants, const TraceSet& set, const char* name)
    : push_bytes_(push_bytes) {
  VkShaderModuleCreateInfo module_info{};
  module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  module_info.codeSize = shader.size_bytes();
  module_info.pCode = shader.data();
  const VolkDeviceTable& vk = device.vk();
  VkShaderModule module = VK_NULL_HANDLE;
  check(vk.vkCreateShaderModule(device.handle(), &module_info, nullptr, &module), name);
  const UniqueShaderModule owned(device, module);

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes};
  VkPipelineLayoutCreateInfo layout_info{};
  layout_info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  const VkDescriptorSetLayout set_layout = set.layout();
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = &set_layout;
  layout_info.pushConstantRangeCount = 1;
  layout_info.pPushConstantRanges = &range;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vk.vkCreatePipelineLayout(device.handle(), &layout_info, nullptr, &layout), name);
  layout_ = UniquePipelineLayout(device, layout);

  std::vector<VkSpecializationMapEntry> entries;
  for (std::uint32_t k = 0; k < constants.size(); ++k)
    entries.push_back({constants[k].id, static_cast<std::uint32_t>(k * sizeof(Constant) + offsetof(Constant, value)),
                       sizeof(std::uint32_t)});
  const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                            constants.size_bytes(), constants.data()};
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vk.vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), name);
  pipeline_ = UniquePipeline(device, pipeline);
  device.name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), name);
}

void ComputePipeline::bind(const VolkDeviceTable& vk, VkCommandBuffer commands, VkDescriptorSet set,
                           const void* push) const {
  vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set, 0, nullptr);
  vk.vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes_, push);
}

}  // namespace vantage::vulkan
