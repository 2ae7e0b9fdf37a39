// SPDX-License-Identifier: Apache-2.0
// The driver's acceleration structure over a scene's triangles, or over boxes around them. Bottom levels hold triangles
// stored in place and meshes that nodes share; a top level places them.
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
  enum class Over {
    triangles,
    boxes,  // of triangles, widened by the error of a caller's own rays (trace/ray_query/find.glsl)
  };
  // On software devices, `scene.sort` sorts triangles so that such drivers build good trees.
  AccelerationStructure(Device& device, Commands& commands, const TraversalScene& scene, Over over = Over::triangles);

  VkAccelerationStructureKHR handle() const { return top_.get(); }
  // Returns, in the structure's order, ids of triangles, or, over boxes, BvhTriangle.
  VkDeviceAddress primitives() const { return primitives_.address(); }
  // Returns QueryInstance, or, over boxes, BvhPlacement, whose root is the first triangle, and whose doubt is 0 for
  // triangles stored in place. 0 if no meshes are shared.
  VkDeviceAddress instances() const { return instances_.address(); }

 private:
  // Triangles of the build with their own structure.
  struct Part {
    std::uint32_t first, count;
    double widening;  // of boxes, in their own frame
    VkDeviceAddress address = 0;
  };
  void build_parts(const TraversalScene& scene, std::span<const Triangle> triangles, std::span<Part> parts, Over over);
  struct Build {
    VkAccelerationStructureBuildGeometryInfoKHR info;
    VkAccelerationStructureGeometryKHR geometry;
    std::uint32_t count;
    VkDeviceSize bytes, scratch;  // of the structure, and to build it
  };
  Build build_of(VkAccelerationStructureTypeKHR type, const VkAccelerationStructureGeometryKHR& geometry,
                 std::uint32_t count) const;
  // `still`: bytes of this structure and of those built after it.
  UniqueAccelerationStructure run(Build build, VkDeviceSize still, Buffer& scratch, const char* name);

  Device& device_;
  Commands& commands_;
  std::vector<Buffer> storage_;  // of structures, which are small if meshes are
  VkDeviceSize used_ = 0;        // bytes of the last one
  std::vector<UniqueAccelerationStructure> bottom_;
  UniqueAccelerationStructure top_;
  Buffer primitives_, instances_;
};

}  // namespace vantage::vulkan
