// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/ray_query/acceleration_structure.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/parallel.hpp"
#include "shared/bvh_types.h"
#include "shared/ray_query_types.h"
#include "trace/vulkan/check.hpp"
#include "trace/vulkan/compute_bvh/bvh.hpp"
#include "trace/vulkan/ray_query/median_sort.hpp"

namespace vantage::vulkan {
namespace {

// Structures lie side by side in buffers of this size, since a device allows few allocations; larger ones lie alone.
constexpr VkDeviceSize kStorageBytes = VkDeviceSize{1} << 26, kStorageAlignment = 256;

constexpr VkBufferUsageFlags kBuildInput = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

VkDeviceAddress address_of(const Device& device, VkAccelerationStructureKHR structure) {
  VkAccelerationStructureDeviceAddressInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
                                                   nullptr, structure};
  return device.vk().vkGetAccelerationStructureDeviceAddressKHR(device.handle(), &info);
}

// A caller's own ray in this frame is off by less than a thirtieth of this share of the largest coordinate; so is a
// driver's version of it. Twice `doubt` covers the way into a shared mesh's frame.
constexpr double kWidening = 0x1p-17;

double largest_of(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }
double largest_of(const Box& box) { return box.empty() ? 0 : std::max(largest_of(box.min), largest_of(box.max)); }

// Returns the widening of the boxes of each shared mesh, for all of its places.
std::vector<double> widenings_of(const TraversalScene& scene) {
  std::vector<double> widenings;
  for (const auto& mesh : scene.placed.meshes) {
    double largest = 0;
    for (const Triangle& triangle : mesh)
      for (const std::uint32_t v : triangle) largest = std::max(largest, largest_of(widen(scene.positions[v])));
    widenings.push_back(kWidening * largest);
  }
  const double size = largest_of(scene.bounds);
  std::vector<double> doubts(widenings.size());
  for (const MeshPlacement& place : scene.placed.placements) {
    const glm::dvec3 at = place.origin();
    doubts[place.mesh] = std::max(doubts[place.mesh], 2 * double{bvh_placement(place, 0).doubt} *
                                                          std::max(size, largest_of(Vec3{at.x, at.y, at.z})));
  }
  std::ranges::transform(widenings, doubts, widenings.begin(), std::plus());
  return widenings;
}

VkAabbPositionsKHR box_around(const TraversalScene& scene, const Triangle& triangle, double widening) {
  Box box;
  for (const std::uint32_t v : triangle) box.extend(widen(scene.positions[v]));
  // Rounds to float, which the widening covers.
  const Vec3 by{widening, widening, widening};
  const Float3 low = narrow(box.min - by), high = narrow(box.max + by);
  return {low.x, low.y, low.z, high.x, high.y, high.z};
}

}  // namespace

AccelerationStructure::Build AccelerationStructure::build_of(VkAccelerationStructureTypeKHR type,
                                                             const VkAccelerationStructureGeometryKHR& geometry,
                                                             std::uint32_t count) const {
  Build build{.info = {}, .geometry = geometry, .count = count, .bytes = 0, .scratch = 0};
  VkAccelerationStructureBuildGeometryInfoKHR& info = build.info;
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

  build.bytes = (sizes.accelerationStructureSize + kStorageAlignment - 1) / kStorageAlignment * kStorageAlignment;
  build.scratch = sizes.buildScratchSize;
  return build;
}

UniqueAccelerationStructure AccelerationStructure::run(Build build, VkDeviceSize still, Buffer& scratch,
                                                       const char* name) {
  if (storage_.empty() || used_ + build.bytes > storage_.back().size()) {
    storage_.emplace_back(device_, std::max(build.bytes, std::min(still, kStorageBytes)), Buffer::Where::device,
                          "acceleration structures", VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
    used_ = 0;
  }
  VkAccelerationStructureCreateInfoKHR create{};
  create.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
  create.buffer = storage_.back().handle();
  create.offset = used_;
  create.size = build.bytes;
  create.type = build.info.type;
  used_ += build.bytes;
  VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
  check(device_.vk().vkCreateAccelerationStructureKHR(device_.handle(), &create, nullptr, &structure), name);
  UniqueAccelerationStructure made(device_, structure);

  const VkDeviceSize alignment = device_.scratch_alignment();
  if (!scratch || scratch.size() < build.scratch + alignment) {
    scratch = Buffer();  // frees the old one first, so that both never coexist
    scratch = Buffer(device_, build.scratch + alignment, Buffer::Where::device, "acceleration structure scratch");
  }
  build.info.pGeometries = &build.geometry;
  build.info.dstAccelerationStructure = structure;
  build.info.scratchData.deviceAddress = (scratch.address() + alignment - 1) / alignment * alignment;
  const VkAccelerationStructureBuildRangeInfoKHR range{build.count, 0, 0, 0};
  // Submits separately and waits, so that later work sees the finished structure and can use the scratch.
  commands_.run([&](const Recorder& r) { r.build(build.info, range); });
  return made;
}

void AccelerationStructure::build_parts(const TraversalScene& scene, std::span<const Triangle> triangles,
                                        std::span<Part> parts, Over over) {
  Buffer vertices, indices, boxes;
  if (over == Over::triangles) {
    vertices = make_device_buffer<Float3>(device_, commands_, scene.positions, "vertices of the build", kBuildInput);
    indices = make_device_buffer<Triangle>(device_, commands_, triangles, "indices of the build", kBuildInput);
  } else {
    std::vector<VkAabbPositionsKHR> around(triangles.size());
    for (const Part& part : parts)
      parallel::for_all(part.first, part.first + part.count,
                        [&](std::uint32_t k) { around[k] = box_around(scene, triangles[k], part.widening); });
    boxes = make_device_buffer<VkAabbPositionsKHR>(device_, commands_, around, "boxes of the build", kBuildInput);
  }
  std::vector<Build> builds;
  VkDeviceSize still = 0;
  for (const Part& part : parts) {
    VkAccelerationStructureGeometryKHR geometry{};
    geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    if (over == Over::triangles) {
      geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
      auto& t = geometry.geometry.triangles;
      t.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
      t.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
      t.vertexData.deviceAddress = vertices.address();
      t.vertexStride = sizeof(Float3);
      t.maxVertex = static_cast<std::uint32_t>(scene.positions.size() - 1);
      t.indexType = VK_INDEX_TYPE_UINT32;
      t.indexData.deviceAddress = indices.address() + part.first * sizeof(Triangle);
    } else {
      geometry.geometryType = VK_GEOMETRY_TYPE_AABBS_KHR;
      geometry.flags |= VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;  // triangles are counted
      auto& b = geometry.geometry.aabbs;
      b.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR;
      b.data.deviceAddress = boxes.address() + part.first * sizeof(VkAabbPositionsKHR);
      b.stride = sizeof(VkAabbPositionsKHR);
    }
    builds.push_back(build_of(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometry, part.count));
    still += builds.back().bytes;
  }
  Buffer scratch;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    bottom_.push_back(run(builds[k], still, scratch, "bottom-level acceleration structure"));
    still -= builds[k].bytes;
    parts[k].address = address_of(device_, bottom_.back().get());
  }
}

AccelerationStructure::AccelerationStructure(Device& device, Commands& commands, const TraversalScene& scene, Over over)
    : device_(device), commands_(commands) {
  // Triangles in the structure's order: those stored in place, then those of each mesh, with ids counted from
  // 0.
  std::vector<Triangle> sorted;
  std::vector<std::uint32_t> ids;
  std::vector<Part> parts;
  std::vector<std::size_t> first_part;  // of the triangles that stand, of each mesh, and an end
  const auto add = [&](std::span<const Triangle> triangles, double widening, const auto& id_of) {
    first_part.push_back(parts.size());
    const std::size_t begin = sorted.size();
    std::vector<std::uint32_t> order;
    if (scene.sort && device.abilities().software()) {
      order = median_sort(scene.positions, triangles);
    } else {
      order.resize(triangles.size());
      std::iota(order.begin(), order.end(), 0u);
    }
    for (const std::uint32_t k : order) {
      sorted.push_back(triangles[k]);
      ids.push_back(id_of(k));
    }
    for (std::size_t first = begin; first < sorted.size(); first += blas_triangles)
      parts.push_back({static_cast<std::uint32_t>(first),
                       static_cast<std::uint32_t>(std::min<std::size_t>(blas_triangles, sorted.size() - first)),
                       widening});
  };
  const std::vector<double> widenings =
      over == Over::boxes ? widenings_of(scene) : std::vector<double>(scene.placed.meshes.size());
  add(scene.triangles, kWidening * largest_of(scene.bounds), [&](std::uint32_t k) { return scene.ids[k]; });
  for (std::size_t m = 0; m < widenings.size(); ++m)
    add(scene.placed.meshes[m], widenings[m], [](std::uint32_t k) { return k; });
  first_part.push_back(parts.size());
  if (over == Over::triangles) {
    primitives_ = make_device_buffer<std::uint32_t>(device, commands, ids, "primitive ids");
  } else {
    std::vector<BvhTriangle> corners(sorted.size());
    parallel::for_all(std::size_t{0}, corners.size(),
                      [&](std::size_t k) { corners[k] = bvh_triangle(scene.positions, sorted[k], ids[k]); });
    primitives_ = make_device_buffer<BvhTriangle>(device, commands, corners, "triangles of boxes");
  }
  build_parts(scene, sorted, parts, over);

  std::vector<VkAccelerationStructureInstanceKHR> instances;
  std::vector<QueryInstance> records;
  std::vector<BvhPlacement> placements;  // over boxes
  const auto place = [&](std::size_t mesh, const VkTransformMatrixKHR& matrix, BvhPlacement placement) {
    for (std::size_t k = first_part[mesh]; k < first_part[mesh + 1]; ++k) {
      VkAccelerationStructureInstanceKHR instance{};
      instance.transform = matrix;
      instance.instanceCustomIndex = static_cast<std::uint32_t>(instances.size()) & 0xFFFFFFu;
      instance.mask = 0xFF;
      instance.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
      instance.accelerationStructureReference = parts[k].address;
      instances.push_back(instance);
      records.push_back({parts[k].first, placement.base});
      placement.root = parts[k].first;
      placements.push_back(placement);
    }
  };
  place(0, {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, {});
  for (const MeshPlacement& placement : scene.placed.placements) {
    const auto& m = placement.columns;
    place(placement.mesh + 1, {{{m[0], m[3], m[6], m[9]}, {m[1], m[4], m[7], m[10]}, {m[2], m[5], m[8], m[11]}}},
          bvh_placement(placement, 0));
  }
  if (!scene.placed.placements.empty())
    instances_ = over == Over::triangles
                     ? make_device_buffer<QueryInstance>(device, commands, records, "instances of shared meshes")
                     : make_device_buffer<BvhPlacement>(device, commands, placements, "placements of boxes");
  const Buffer instance_buffer =
      make_device_buffer<VkAccelerationStructureInstanceKHR>(device, commands, instances, "instances", kBuildInput);
  VkAccelerationStructureGeometryKHR geometry{};
  geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
  geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
  geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
  geometry.geometry.instances.data.deviceAddress = instance_buffer.address();
  const Build top =
      build_of(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, geometry, static_cast<std::uint32_t>(instances.size()));
  Buffer scratch;
  top_ = run(top, top.bytes, scratch, "top-level acceleration structure");
}

}  // namespace vantage::vulkan
