// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/vulkan_tracer.hpp"

#include <algorithm>
#include <utility>

namespace vantage::vulkan {

namespace {

constexpr double kSecondsPerExactSubmission = 0.25;  // often enough for progress, and to stop in time
// A sampled population is one submission unless it takes longer than this, half of the shortest usual watchdog limit.
constexpr double kSecondsPerSampledSubmission = 1;
// The first dispatch of an exact submission has this share of the limit, to measure the device's speed.
constexpr double kFirstShare = 1.0 / 16;

// Returns true if two scenes have the same triangles with the same attributes, except for their corners' places.
bool differ_by_places_alone(const SceneData& one, const SceneData& other) {
  const auto alike = [&](std::size_t m) {
    return one.ranges[m].first_triangle == other.ranges[m].first_triangle &&
           one.ranges[m].triangle_count == other.ranges[m].triangle_count &&
           one.meshes[m].role == other.meshes[m].role && one.meshes[m].diffuse == other.meshes[m].diffuse;
  };
  if (one.shares() || other.shares() || one.meshes.size() != other.meshes.size() ||
      one.positions.size() != other.positions.size() || one.normals.size() != other.normals.size() ||
      one.opaque_count() != other.opaque_count() || one.triangles != other.triangles)
    return false;
  for (std::size_t m = 0; m < one.meshes.size(); ++m)
    if (!alike(m)) return false;
  return true;
}

bool have_the_same_limits(const TraceScene& one, const TraceScene& other) {
  return std::ranges::equal(one.scanners, other.scanners, [](const TraceScanner& a, const TraceScanner& b) {
    return !a.limits == !b.limits && (!a.limits || a.limits->meshes == b.limits->meshes);
  });
}

}  // namespace

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
      device_scene_(device_, commands_, scene_, *traversal_, scanners_),
      kernels_(device_, info_.software, *traversal_, scanners_.front().set(), weakens_through_glass(scene_),
               scene_.scene->shares()),
      exact_sizer_(kSecondsPerExactSubmission, kFirstShare * static_cast<double>(rays_per_dispatch()), 1,
                   static_cast<double>(rays_per_dispatch())),
      sampled_sizer_(kSecondsPerSampledSubmission, room_for_sample().rays, 1, 0.5 * room_for_sample().rays) {}

std::unique_ptr<Traversal> VulkanTracer::build_traversal(const VulkanEngine& engine) {
  const SceneData& scene = *scene_.scene;
  std::vector<std::uint32_t> ids;  // of triangles stored in place, in stored order
  const auto add = [&](std::uint32_t first, std::uint32_t count) {
    if (first >= scene.opaque_count()) return;
    const std::uint32_t bit = scene.meshes[scene.mesh_of(first)].role == Role::surveyed ? surveyed_bit : 0;
    for (std::uint32_t t = first; t < first + count; ++t) ids.push_back(t | bit);
  };
  if (scene.shares()) {
    for (const MeshInstance& run : scene.instances)
      if (run.place == MeshInstance::kNoPlace) add(run.first_triangle, run.triangle_count);
  } else {
    for (const MeshRange& mesh : scene.ranges) add(mesh.first_triangle, mesh.triangle_count);
  }
  const PlacedMeshes placed = placed_meshes(scene);
  return engine.build(
      device_, commands_,
      {scene.positions, std::span(scene.triangles).first(ids.size()), ids, scene_.sort_triangles, placed});
}

bool VulkanTracer::take(const TraceScene& later, const SceneDifference& difference) {
  const SceneData& scene = *later.scene;
  if (difference.shifted() || !differ_by_places_alone(*scene_.scene, scene) || !have_the_same_limits(scene_, later) ||
      weakens_through_glass(later))
    return false;
  if (!traversal_->move(commands_, scene, not_kept(difference.kept, scene.opaque_count()))) return false;
  scene_ = later;
  device_scene_.take(difference, not_kept(difference.kept, static_cast<std::uint32_t>(scene.triangles.size())));
  samples_ = {}, registration_.uploaded_patches = nullptr;
  return true;
}

std::vector<DeviceScanner> VulkanTracer::make_scanners() {
  std::vector<DeviceScanner> scanners;
  for (const TraceScanner& scanner : scene_.scanners)
    scanners.emplace_back(device_, commands_, traversal_->binding().structure, *scene_.scene, scanner);
  return scanners;
}

}  // namespace vantage::vulkan
