// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/vulkan_tracer.hpp"

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

#include "core/normal_table.hpp"
#include "trace/triangle_neighbours.hpp"
#include "vantage/error.hpp"

namespace vantage::vulkan {

namespace {

constexpr double seconds_per_exact_submission = 0.25;  // often enough for progress, and to stop in time
// A sampled population is one submission unless it takes longer than this, half of the shortest usual watchdog limit.
constexpr double seconds_per_sampled_submission = 1;
// The first dispatch of an exact submission has this share of the limit, to measure the device's speed.
constexpr double first_share = 1.0 / 16;

}  // namespace

static_assert(std::is_trivially_copyable_v<TraceParameters> && sizeof(Float3) == sizeof(vec3));
static_assert(group_size == block_columns * block_rows && tile_side % block_columns == 0 &&
              tile_side % block_rows == 0);

VulkanTracer::VulkanTracer(const VulkanEngine& engine, const EngineInfo& info, std::shared_ptr<Instance> instance,
                           VkPhysicalDevice physical, const DeviceAbilities& abilities, const TraceScene& scene)
    : info_(info),
      scene_(scene),
      device_(std::move(instance), physical, abilities, engine.needs),
      commands_(device_),
      traversal_(build_traversal(engine)),
      scanners_(make_scanners()),
      kernels_(device_, *traversal_, scanners_.front().set()),
      exact_sizer_(seconds_per_exact_submission, first_share * static_cast<double>(rays_per_dispatch()), 1,
                   static_cast<double>(rays_per_dispatch())),
      sampled_sizer_(seconds_per_sampled_submission, room_for_sample().rays, 1, 0.5 * room_for_sample().rays) {
  std::ranges::copy(traversal_->binding().arrays, parameters_.traversal);
  upload_scene();
}

std::unique_ptr<Traversal> VulkanTracer::build_traversal(const VulkanEngine& engine) {
  const SceneData& scene = *scene_.scene;
  std::vector<std::uint32_t> ids(scene.triangles.size());
  for (std::size_t m = 0; m < scene.ranges.size(); ++m) {
    const std::uint32_t bit = scene.meshes[m].role == Role::surveyed ? surveyed_bit : 0;
    for (std::uint32_t t = 0; t < scene.ranges[m].triangle_count; ++t)
      ids[scene.ranges[m].first_triangle + t] = (scene.ranges[m].first_triangle + t) | bit;
  }
  return engine.build(device_, commands_, {scene.positions, scene.triangles, ids, scene_.sort_triangles});
}

std::vector<DeviceScanner> VulkanTracer::make_scanners() {
  std::vector<DeviceScanner> scanners;
  for (const TraceScanner& scanner : scene_.scanners)
    scanners.emplace_back(device_, commands_, traversal_->binding().structure, *scene_.scene, scanner);
  return scanners;
}

void VulkanTracer::upload_scene() {
  const VoxelGrid& grid = *scene_.grid;
  demands_ = to_device(grid.demands());
  bricks_ = to_device<VoxelBrick>(grid.bricks(), "voxel bricks");
  slots_ = to_device<BrickSlot>(grid.slots(), "brick slots");
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
  const auto noisy = [](const DeviceScanner& scanner) { return scanner.noise(); };
  const auto limited = [](const DeviceScanner& scanner) { return scanner.limits(); };
  if (std::ranges::any_of(scanners_, noisy)) {
    normal_table_ = to_device<float>(normal_table(), "normal table");
    p.normal_table = normal_table_.address();
  }
  if (std::ranges::any_of(scanners_, noisy) || std::ranges::any_of(scanners_, limited)) {
    upload_shading();
  } else {
    write_parameters();
  }
}

void VulkanTracer::write_parameters() {
  for (const DeviceScanner& scanner : scanners_) scanner.write(commands_, parameters_);
}

void VulkanTracer::upload_triangles() {
  if (positions_) return;
  triangles_ = to_device<Triangle>(scene_.scene->triangles, "triangles");
  positions_ = to_device<Float3>(scene_.scene->positions, "positions");
  parameters_.positions = positions_.address();
  parameters_.triangles = triangles_.address();
  write_parameters();
}

void VulkanTracer::upload_neighbours() {
  if (neighbours_ || !traversal_->is_watertight()) return;
  neighbours_ = to_device<std::uint32_t>(triangle_neighbours(scene_.scene->positions, scene_.scene->triangles),
                                         "triangle neighbours");
  parameters_.neighbours = neighbours_.address();
  write_parameters();
}

void VulkanTracer::upload_shading() {
  if (diffuse_) return;
  upload_triangles();
  const SceneData& scene = *scene_.scene;
  std::vector<float> diffuse(scene.triangles.size());
  for (std::size_t m = 0; m < scene.ranges.size(); ++m)
    std::fill_n(diffuse.begin() + scene.ranges[m].first_triangle, scene.ranges[m].triangle_count,
                static_cast<float>(scene.meshes[m].diffuse));
  diffuse_ = to_device<float>(diffuse, "diffuse coefficients");
  if (!scene.normals.empty()) normals_ = to_device<Float3>(scene.normals, "normals");
  parameters_.diffuse = diffuse_.address();
  parameters_.normals = scene.normals.empty() ? 0 : normals_.address();
  write_parameters();
}

}  // namespace vantage::vulkan
