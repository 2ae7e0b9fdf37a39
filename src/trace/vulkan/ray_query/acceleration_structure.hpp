// SPDX-License-Identifier: Apache-2.0
// The driver's acceleration structure over all triangles of a scene.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/vulkan/commands.hpp"

namespace vantage::vulkan {

class AccelerationStructure {
 public:
  // `ids[k]` becomes entry k of the map back to the scene, in the structure's order of triangles. `sort`: on software
  // devices, sorts triangles so that such drivers build good trees.
  AccelerationStructure(Device& device, Commands& commands, std::span<const Float3> positions,
                        std::span<const Triangle> triangles, std::span<const std::uint32_t> ids, bool sort);

  VkAccelerationStructureKHR handle() const { return top_.handle.get(); }
  VkDeviceAddress primitive_ids() const { return ids_.address(); }

 private:
  struct Level {
    Buffer storage;
    UniqueAccelerationStructure handle;
  };
  Level build(VkAccelerationStructureTypeKHR type, const VkAccelerationStructureGeometryKHR& geometry,
              std::uint32_t count, const char* name);

  Device& device_;
  Commands& commands_;
  std::vector<Level> bottom_;
  Level top_;
  Buffer ids_;
};

}  // namespace vantage::vulkan
