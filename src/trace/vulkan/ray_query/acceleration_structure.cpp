// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/ray_query/acceleration_structure.hpp"

#include <algorithm>
#include <numeric>

#include "shared/ray_query_types.h"
#include "trace/vulkan/check.hpp"
#include "trace/vulkan/ray_query/median_sort.hpp"

namespace vantage::vulkan {
namespace {

VkDeviceAddress address_of(const Device& device, VkAccelerationStructureKHR structure) {
  VkAccelerationStructureDeviceAddressInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
                                                   nullptr, structure};
  return device.vk().vkGetAccelerationStructureDeviceAddressKHR(device.handle(), &info);
}

}  // namespace

AccelerationStructure::Level AccelerationStructure::build(VkAccelerationStructureTypeKHR type,
                                                          const VkAccelerationStructureGeometryKHR& geometry,
                                                          std::uint32_t count, const char* name) {
  VkAccelerationStructureBuildGeometryInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
  info.type = type;
  info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
  info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
  info.geometryCount = 1;
  info.pGeometries = &geometry;
  VkAccelerationStructureBuildSizesInfoKHR sizes{};
  sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
  device_.vk().vkGetAccelerationStructureBuildSizesKHR(
      device_.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &count, &sizes);

  Level level;
  level.storage = Buffer(device_, sizes.accelerationStructureSize, Buffer::Where::device, name,
                         VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
  VkAccelerationStructureCreateInfoKHR create{};
  create.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
  create.buffer = level.storage.handle();
  create.size = sizes.accelerationStructureSize;
  create.type = type;
  VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
  check(device_.vk().vkCreateAccelerationStructureKHR(device_.handle(), &create, nullptr, &structure), name);
  level.handle = UniqueAccelerationStructure(device_, structure);

  const VkDeviceSize alignment = device_.scratch_alignment();
  const Buffer scratch(device_, sizes.buildScratchSize + alignment, Buffer::Where::device,
                       "acceleration structure scratch");
  info.dstAccelerationStructure = structure;
  info.scratchData.deviceAddress = (scratch.address() + alignment - 1) / alignment * alignment;
  const VkAccelerationStructureBuildRangeInfoKHR range{count, 0, 0, 0};
  // Submits separately and waits, so that later work sees the finished structure and the scratch can be freed.
  commands_.run([&](const Recorder& r) { r.build(info, range); });
  return level;
}

AccelerationStructure::AccelerationStructure(Device& device, Commands& commands, std::span<const Float3> positions,
                                             std::span<const Triangle> triangles, std::span<const std::uint32_t> ids,
                                             bool sort)
    : device_(device), commands_(commands) {
  std::vector<std::uint32_t> order;
  if (sort && device.abilities().software()) {
    order = median_sort(positions, triangles);
  } else {
    order.resize(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
  }
  std::vector<Triangle> sorted(order.size());
  std::vector<std::uint32_t> sorted_ids(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    sorted[k] = triangles[order[k]];
    sorted_ids[k] = ids[order[k]];
  }
  ids_ = make_device_buffer<std::uint32_t>(device, commands, sorted_ids, "primitive ids");

  const VkBufferUsageFlags input = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
  const Buffer vertices = make_device_buffer<Float3>(device, commands, positions, "vertices of the build", input);
  const Buffer indices = make_device_buffer<Triangle>(device, commands, sorted, "indices of the build", input);
  std::vector<VkAccelerationStructureInstanceKHR> instances;
  for (std::size_t first = 0; first < sorted.size(); first += blas_triangles) {
    const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(blas_triangles, sorted.size() - first));
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    auto& t = geometry.geometry.triangles;
    t.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    t.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    t.vertexData.deviceAddress = vertices.address();
    t.vertexStride = sizeof(Float3);
    t.maxVertex = static_cast<std::uint32_t>(positions.size() - 1);
    t.indexType = VK_INDEX_TYPE_UINT32;
    t.indexData.deviceAddress = indices.address() + first * sizeof(Triangle);
    bottom_.push_back(
        build(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometry, count, "bottom-level acceleration structure"));
    VkAccelerationStructureInstanceKHR instance{};
    instance.transform = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    instance.instanceCustomIndex = static_cast<std::uint32_t>(instances.size()) & 0xFFFFFFu;
    instance.mask = 0xFF;
    instance.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
    instance.accelerationStructureReference = address_of(device, bottom_.back().handle.get());
    instances.push_back(instance);
  }
  const Buffer instance_buffer =
      make_device_buffer<VkAccelerationStructureInstanceKHR>(device, commands, instances, "instances", input);
  VkAccelerationStructureGeometryKHR geometry{};
  geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
  geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
  geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
  geometry.geometry.instances.data.deviceAddress = instance_buffer.address();
  top_ = build(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, geometry, static_cast<std::uint32_t>(instances.size()),
               "top-level acceleration structure");
}

}  // namespace vantage::vulkan
