// SPDX-License-Identifier: Apache-2.0
// The driver's acceleration structure over a scene: bottom levels of the triangles that are stored where they stand and
// of meshes that nodes share, and a top level that places them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/vulkan/commands.hpp"
#include "trace/vulkan/traversal.hpp"

namespace vantage::vulkan {

class AccelerationStructure {
 public:
  // On software devices, `scene.sort` sorts triangles so that such drivers build good trees.
  AccelerationStructure(Device& device, Commands& commands, const TraversalScene& scene);

  VkAccelerationStructureKHR handle() const { return top_.get(); }
  VkDeviceAddress primitive_ids() const { return ids_.address(); }
  VkDeviceAddress instances() const { return instances_.address(); }  // 0 if no meshes are shared

 private:
  // Triangles of the build that have a structure of their own.
  struct Part {
    std::uint32_t first, count;
    VkDeviceAddress address = 0;
  };
  void build_parts(const TraversalScene& scene, std::span<const Triangle> triangles, std::span<Part> parts);
  struct Build {
    VkAccelerationStructureBuildGeometryInfoKHR info;
    VkAccelerationStructureGeometryKHR geometry;
    std::uint32_t count;
    VkDeviceSize bytes, scratch;  // of the structure, and to build it
  };
  Build build_of(VkAccelerationStructureTypeKHR type, const VkAccelerationStructureGeometryKHR& geometry,
                 std::uint32_t count) const;
  // `still`: bytes of this structure and of those that will be built behind it.
  UniqueAccelerationStructure run(Build build, VkDeviceSize still, Buffer& scratch, const char* name);

  Device& device_;
  Commands& commands_;
  std::vector<Buffer> storage_;  // of structures, which are small if meshes are
  VkDeviceSize used_ = 0;        // of the last one
  std::vector<UniqueAccelerationStructure> bottom_;
  UniqueAccelerationStructure top_;
  Buffer ids_, instances_;
};

}  // namespace vantage::vulkan
