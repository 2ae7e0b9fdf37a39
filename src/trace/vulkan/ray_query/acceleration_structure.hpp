// SPDX-License-Identifier: Apache-2.0
// The driver's acceleration structure over all triangles of a scene, and the descriptor set through which shaders query it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/vulkan/commands.hpp"

namespace vantage::vulkan {

class AccelerationStructure {
 public:
  // `ids[k]` becomes entry k of the map back to the scene, in the order that the structure numbers triangles.
  AccelerationStructure(Device& device, Commands& commands, std::span<const Float3> positions, std::span<const Triangle> triangles,
                        std::span<const std::uint32_t> ids);

  VkDescriptorSetLayout set_layout() const { return set_layout_.get(); }
  VkDescriptorSet set() const { return set_; }
  VkDeviceAddress primitive_ids() const { return ids_.address(); }

 private:
  struct Level {
    Buffer storage;
    UniqueAccelerationStructure handle;
  };
  Level build(VkAccelerationStructureTypeKHR type, const VkAccelerationStructureGeometryKHR& geometry, std::uint32_t count, const char* name);

  Device& device_;
  Commands& commands_;
  std::vector<Level> bottom_;
  Level top_;
  Buffer ids_;
  UniqueSetLayout set_layout_;
  UniqueDescriptorPool pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace vantage::vulkan
