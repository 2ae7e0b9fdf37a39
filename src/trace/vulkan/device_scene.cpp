// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/device_scene.hpp"

#include <algorithm>
#include <type_traits>
#include <vector>

#include "core/normal_table.hpp"
#include "trace/glass_faces.hpp"
#include "trace/triangle_neighbours.hpp"
#include "trace/vulkan/compute_bvh/bvh.hpp"

namespace vantage::vulkan {

static_assert(std::is_trivially_copyable_v<TraceParameters> && sizeof(Float3) == sizeof(vec3));

DeviceScene::DeviceScene(Device& device, Commands& commands, const TraceScene& scene, const Traversal& traversal,
                         std::span<const DeviceScanner> scanners)
    : device_(device), commands_(commands), scene_(scene), scanners_(scanners), watertight_(traversal.is_watertight()) {
  std::ranges::copy(traversal.binding().arrays, parameters_.traversal);
  const VoxelGrid& grid = *scene_.grid;
  demands_ = make_device_demands(device_, commands_, grid.demands());
  bricks_ = make_device_buffer<VoxelBrick>(device_, commands_, grid.bricks(), "voxel bricks");
  slots_ = make_device_buffer<BrickSlot>(device_, commands_, grid.slots(), "brick slots");
  TraceParameters& p = parameters_;
  p.bricks = bricks_.address();
  p.slots = slots_.address();
  p.voxel_min = {grid.min()[0], grid.min()[1], grid.min()[2]};
  p.voxel_inverse_size = grid.inverse_size();
  p.voxel_cells = 1u << grid.depth();
  p.slot_mask = static_cast<std::uint32_t>(grid.slots().size() - 1);
  p.brick_count = static_cast<std::uint32_t>(grid.bricks().size());
  p.brick_size = static_cast<float>(grid.voxel_size() * (1u << brick_bits));
  const Box& bounds = scene_.scene->local_bounds;
  p.bounds_min = {static_cast<float>(bounds.min.x), static_cast<float>(bounds.min.y), static_cast<float>(bounds.min.z)};
  p.bounds_max = {static_cast<float>(bounds.max.x), static_cast<float>(bounds.max.y), static_cast<float>(bounds.max.z)};
  p.has_normals = scene_.scene->normals.empty() ? 0 : 1;
  if (weakens_through_glass(scene_)) upload_glass();
  const auto noisy = [](const DeviceScanner& scanner) { return scanner.noise(); };
  const auto limited = [](const DeviceScanner& scanner) { return scanner.limits(); };
  if (std::ranges::any_of(scanners_, noisy)) {
    normal_table_ = make_device_buffer<float>(device_, commands_, normal_table(), "normal table");
    p.normal_table = normal_table_.address();
  }
  if (std::ranges::any_of(scanners_, noisy) || std::ranges::any_of(scanners_, limited)) {
    upload_shading();
  } else {
    write_parameters();
  }
}

void DeviceScene::write_parameters() {
  for (const DeviceScanner& scanner : scanners_) scanner.write(commands_, parameters_);
}

// For all engines alike, since it is small.
void DeviceScene::upload_glass() {
  const SceneData& scene = *scene_.scene;
  const std::size_t first = scene.opaque_triangles().size();
  const std::vector<bool> of_solid = faces_of_solids(scene);
  std::vector<std::uint32_t> ids(of_solid.size());
  for (std::size_t k = 0; k < ids.size(); ++k)
    ids[k] = static_cast<std::uint32_t>(first + k) | (of_solid[k] ? surveyed_bit : 0);
  const Bvh bvh = build_bvh(scene.positions, std::span(scene.triangles).subspan(first), ids);
  glass_nodes_ = make_device_buffer<BvhNode>(device_, commands_, bvh.nodes, "nodes of glass");
  glass_corners_ = make_device_buffer<BvhTriangle>(device_, commands_, bvh.triangles, "triangles of glass");
  parameters_.glass_nodes = glass_nodes_.address();
  parameters_.glass_corners = glass_corners_.address();
}

void DeviceScene::upload_triangles() {
  if (positions_) return;
  triangles_ = make_device_buffer<Triangle>(device_, commands_, scene_.scene->triangles, "triangles");
  positions_ = make_device_buffer<Float3>(device_, commands_, scene_.scene->positions, "positions");
  parameters_.positions = positions_.address();
  parameters_.triangles = triangles_.address();
  write_parameters();
}

void DeviceScene::upload_neighbours() {
  if (neighbours_ || !watertight_) return;
  neighbours_ = make_device_buffer<std::uint32_t>(
      device_, commands_, triangle_neighbours(scene_.scene->positions, scene_.scene->opaque_triangles()),
      "triangle neighbours");
  parameters_.neighbours = neighbours_.address();
  write_parameters();
}

void DeviceScene::upload_shading() {
  if (diffuse_) return;
  upload_triangles();
  const SceneData& scene = *scene_.scene;
  std::vector<float> diffuse(scene.triangles.size());
  for (std::size_t m = 0; m < scene.ranges.size(); ++m)
    std::fill_n(diffuse.begin() + scene.ranges[m].first_triangle, scene.ranges[m].triangle_count,
                static_cast<float>(scene.meshes[m].diffuse));
  diffuse_ = make_device_buffer<float>(device_, commands_, diffuse, "diffuse coefficients");
  if (!scene.normals.empty()) normals_ = make_device_buffer<Float3>(device_, commands_, scene.normals, "normals");
  parameters_.diffuse = diffuse_.address();
  parameters_.normals = scene.normals.empty() ? 0 : normals_.address();
  write_parameters();
}

}  // namespace vantage::vulkan
