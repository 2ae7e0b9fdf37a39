// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/vulkan_ray_finder.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "trace/vulkan/groups.hpp"

namespace vantage::vulkan {
namespace {

// Rays of a batch: enough to fill the device, and few enough for the slowest device to trace them within a fraction of
// a second. With the memory of a slot, 36 bytes each, every device has room for them.
constexpr std::size_t kHardwareBatch = std::size_t{1} << 22, kSoftwareBatch = std::size_t{1} << 17;

std::unique_ptr<RayWalk> walk_over(const VulkanEngine& engine, Device& device, Commands& commands,
                                   const SceneData& scene) {
  std::vector<std::uint32_t> ids;  // of triangles stored in place, in stored order
  const auto add = [&](std::uint32_t first, std::uint32_t stored, std::uint32_t count) {
    ids.resize(std::max<std::size_t>(ids.size(), stored + std::size_t{count}));
    for (std::uint32_t k = 0; k < count; ++k) ids[stored + k] = first + k;
  };
  if (!scene.shares()) add(0, 0, scene.triangle_count());
  for (const MeshInstance& run : scene.instances)
    if (run.place == MeshInstance::kNoPlace) add(run.first_triangle, run.first_stored, run.triangle_count);
  PlacedMeshes placed = placed_meshes(scene, true);
  for (MeshPlacement& placement : placed.placements) placement.base_id &= ~surveyed_bit;
  return engine.build_walk(device, commands,
                           {.positions = scene.positions,
                            .triangles = std::span(scene.triangles).first(ids.size()),
                            .ids = ids,
                            .placed = placed,
                            .bounds = scene.local_bounds});
}

Buffer parameter_block(Device& device, Commands& commands, const SceneData& scene, const TraversalBinding& binding) {
  TraceParameters parameters{};
  std::ranges::copy(binding.arrays, parameters.traversal);
  const Float3 low = narrow(scene.local_bounds.min), high = narrow(scene.local_bounds.max);
  parameters.bounds_min = {low.x, low.y, low.z};
  parameters.bounds_max = {high.x, high.y, high.z};
  return make_device_buffer<TraceParameters>(device, commands, {&parameters, 1}, "parameters of own rays",
                                             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
}

}  // namespace

VulkanRayFinder::VulkanRayFinder(const VulkanEngine& engine, const EngineInfo& info, std::shared_ptr<Instance> instance,
                                 VkPhysicalDevice physical, const DeviceAbilities& abilities, const SceneData& scene)
    : info_(info),
      shares_(scene.shares()),
      device_(std::move(instance), physical, abilities, engine.needs),
      commands_(device_),
      walk_(walk_over(engine, device_, commands_, scene)),
      parameters_(parameter_block(device_, commands_, scene, walk_->binding())),
      set_(device_, parameters_, walk_->binding().structure) {}

std::size_t VulkanRayFinder::most_rays() const { return info_.software ? kSoftwareBatch : kHardwareBatch; }

void VulkanRayFinder::reserve(std::size_t rays) {
  if (rays <= room_) return;
  room_ = 0;
  rays_ = Buffer();  // frees old ones first, so that both never coexist
  answers_ = Buffer();
  slots_ = {};
  const VkDeviceSize in = rays * sizeof(OwnRay), out = rays * sizeof(std::uint32_t);
  rays_ = Buffer(device_, in, Buffer::Where::device, "own rays");
  answers_ = Buffer(device_, out, Buffer::Where::device, "answers to own rays");
  for (Slot& slot : slots_)
    slot = {Buffer(device_, in, Buffer::Where::upload, "own rays up"),
            Buffer(device_, out, Buffer::Where::download, "answers down")};
  room_ = rays;
}

void VulkanRayFinder::find(std::size_t slot, std::size_t count, RayQuestion question, std::uint32_t end) {
  const BoundPipeline bound{&pipeline(question), set_.handle()};
  const std::uint32_t groups = groups_of(count);
  const OwnRaysPush push{rays_.address(), answers_.address(), static_cast<std::uint32_t>(count), end};
  commands_.run([&](const Recorder& r) { r.copy(slots_[slot].rays, rays_, {0, 0, count * sizeof(OwnRay)}); });
  device_seconds_ += commands_.run([&](const Recorder& r) {
    r.dispatch(bound, push, std::min(groups, groups_in_row), groups_of(groups, groups_in_row));
  });
  commands_.run([&](const Recorder& r) {
    r.copy(answers_, slots_[slot].answers, {0, 0, count * sizeof(std::uint32_t)});
  });
}

const ComputePipeline& VulkanRayFinder::pipeline(RayQuestion question) {
  const auto known = pipelines_.find(question);
  if (known != pipelines_.end()) return known->second;
  const ComputePipeline::Constant constants[] = {{0, static_cast<std::uint32_t>(question)}, {shared_constant, shares_}};
  return pipelines_
      .emplace(question, ComputePipeline(device_, walk_->own_rays(), sizeof(OwnRaysPush), constants, set_, "own rays"))
      .first->second;
}

}  // namespace vantage::vulkan
