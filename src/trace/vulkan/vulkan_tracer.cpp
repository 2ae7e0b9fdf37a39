// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/vulkan_tracer.hpp"

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

#include "core/normal_table.hpp"
#include "trace/vulkan/sample_plan.hpp"
#include "vantage/error.hpp"

namespace vantage::vulkan {

namespace {

constexpr double seconds_per_exact_submission = 0.25;  // often enough for reports, and to stop in time
// A population of samples is one submission where it takes no longer than this, half of the shortest usual limit.
constexpr double seconds_per_sampled_submission = 1;
constexpr double first_sampled_rays_on_hardware = 1e9;

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
      parameters_buffer_(device_, sizeof parameters_, Buffer::Where::device, "trace parameters",
                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT),
      set_(device_, parameters_buffer_, traversal_->binding().structure),
      kernels_(device_, *traversal_, set_),
      exact_pace_(seconds_per_exact_submission, static_cast<double>(rays_per_dispatch()),
                  static_cast<double>(rays_per_dispatch()), static_cast<double>(rays_per_dispatch())),
      sampled_pace_(seconds_per_sampled_submission,
                    info.software || scene.max_rays_per_dispatch > 0 ? 0 : first_sampled_rays_on_hardware, 0,
                    0.5 * sample_room(scene.pattern->columns(), info.software, scene.max_rays_per_dispatch).rays) {
  if (scene.pattern->rows() > most_groups * block_rows ||
      std::uint64_t{scene.pattern->rows()} * scene.pattern->columns() >= std::uint64_t{1} << 31)
    throw Error(Errc::invalid_argument, "the scan pattern has " + std::to_string(scene.pattern->rows()) + " x " +
                                            std::to_string(scene.pattern->columns()) +
                                            " rays; this engine takes fewer than 2^31 a station: use larger steps");
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

void VulkanTracer::upload_scene() {
  const RayPattern& pattern = *scene_.pattern;
  const VoxelGrid& grid = *scene_.grid;
  sin_zenith_ = to_device<float>(pattern.sin_zenith, "sin zenith");
  cos_zenith_ = to_device<float>(pattern.cos_zenith, "cos zenith");
  sin_azimuth_ = to_device<float>(pattern.sin_azimuth, "sin azimuth");
  cos_azimuth_ = to_device<float>(pattern.cos_azimuth, "cos azimuth");
  if (!grid.weights().empty()) weights_ = bytes_to_device(grid.weights(), "voxel weights");
  bricks_ = to_device<VoxelBrick>(grid.bricks(), "voxel bricks");
  slots_ = to_device<BrickSlot>(grid.slots(), "brick slots");
  TraceParameters& p = parameters_;
  p.sin_zenith = sin_zenith_.address();
  p.cos_zenith = cos_zenith_.address();
  p.sin_azimuth = sin_azimuth_.address();
  p.cos_azimuth = cos_azimuth_.address();
  p.bricks = bricks_.address();
  p.slots = slots_.address();
  p.rows = pattern.rows();
  p.columns = pattern.columns();
  p.min_range = pattern.min_range;
  p.max_range = pattern.max_range;
  p.voxel_min = {grid.min()[0], grid.min()[1], grid.min()[2]};
  p.voxel_inverse_size = grid.inverse_size();
  p.voxel_cells = 1u << grid.depth();
  p.slot_mask = static_cast<std::uint32_t>(grid.slots().size() - 1);
  p.brick_count = static_cast<std::uint32_t>(grid.bricks().size());
  p.brick_size = static_cast<float>(grid.voxel_size() * (1u << brick_bits));
  const Box& bounds = scene_.scene->local_bounds;
  p.bounds_min = {static_cast<float>(bounds.min.x), static_cast<float>(bounds.min.y), static_cast<float>(bounds.min.z)};
  p.bounds_max = {static_cast<float>(bounds.max.x), static_cast<float>(bounds.max.y), static_cast<float>(bounds.max.z)};
  p.zenith_step = static_cast<float>(pattern.zenith_step);
  p.azimuth_step = static_cast<float>(pattern.azimuth_step);
  p.first_zenith = static_cast<float>(pattern.first_zenith);
  p.first_azimuth = static_cast<float>(pattern.first_azimuth);
  p.has_normals = scene_.scene->normals.empty() ? 0 : 1;
  if (noise()) upload_noise();
  if (limits()) upload_limits();
  if (noise() || limits()) {
    upload_shading();
  } else {
    write_parameters();
  }
}

void VulkanTracer::upload_sigma(const NoiseModel& model) {
  sigma_ = to_device<float>(model.sigma, "sigma table");
  parameters_.sigma = sigma_.address();
  parameters_.noise_min_range = model.min_range;
  parameters_.noise_inverse_span = model.inverse_span;
}

void VulkanTracer::upload_noise() {
  const NoiseModel& model = *scene_.noise;
  upload_sigma(model);
  normal_table_ = to_device<float>(normal_table(), "normal table");
  reaches_ = noise_reaches(model);
  noise_reaches_ = to_device<float>(reaches_, "noise reaches");
  TraceParameters& p = parameters_;
  p.noise_reaches = noise_reaches_.address();
  p.normal_table = normal_table_.address();
  p.noise_reach = model.reach;
  p.seed_low = static_cast<std::uint32_t>(model.seed);
  p.seed_high = static_cast<std::uint32_t>(model.seed >> 32);
}

// Meshes that ask for the same share one entry.
void VulkanTracer::upload_limits() {
  const LimitModel& model = *scene_.limits;
  const SceneData& scene = *scene_.scene;
  std::vector<LimitModel::Limits> distinct;
  std::vector<PointLimits> limits;
  std::vector<std::uint32_t> of_triangle(scene.triangles.size());
  for (std::size_t m = 0; m < scene.ranges.size(); ++m) {
    const LimitModel::Limits& own = model.meshes[m];
    const auto found = std::ranges::find(distinct, own);
    const auto index = static_cast<std::uint32_t>(found - distinct.begin());
    if (found == distinct.end()) {
      distinct.push_back(own);
      limits.push_back({own.least_cosine_square, own.largest_footprint_square, own.largest_sigma});
    }
    std::fill_n(of_triangle.begin() + scene.ranges[m].first_triangle, scene.ranges[m].triangle_count, index);
  }
  limits_ = to_device<PointLimits>(limits, "point limits");
  limits_of_ = to_device<std::uint32_t>(of_triangle, "limits of triangles");
  if (!noise() && model.noise) upload_sigma(*model.noise);
  TraceParameters& p = parameters_;
  p.limits = limits_.address();
  p.limits_of = limits_of_.address();
  p.exit_diameter = model.exit_diameter;
  p.divergence = model.divergence;
}

void VulkanTracer::upload_shading() {
  if (positions_) return;
  const SceneData& scene = *scene_.scene;
  positions_ = to_device<Float3>(scene.positions, "positions");
  triangles_ = to_device<Triangle>(scene.triangles, "triangles");
  std::vector<float> diffuse(scene.triangles.size());
  for (std::size_t m = 0; m < scene.ranges.size(); ++m)
    std::fill_n(diffuse.begin() + scene.ranges[m].first_triangle, scene.ranges[m].triangle_count,
                static_cast<float>(scene.meshes[m].diffuse));
  diffuse_ = to_device<float>(diffuse, "diffuse coefficients");
  if (!scene.normals.empty()) normals_ = to_device<Float3>(scene.normals, "normals");
  parameters_.positions = positions_.address();
  parameters_.triangles = triangles_.address();
  parameters_.diffuse = diffuse_.address();
  parameters_.normals = scene.normals.empty() ? 0 : normals_.address();
  write_parameters();
}

}  // namespace vantage::vulkan
