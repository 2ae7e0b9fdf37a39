// SPDX-License-Identifier: Apache-2.0
// A caller's own rays on a Vulkan device. Engines differ only in their RayWalk.
#pragma once

#include <array>
#include <map>
#include <memory>

#include "trace/rays/ray_finder.hpp"
#include "trace/vulkan/commands.hpp"
#include "trace/vulkan/pipeline.hpp"
#include "trace/vulkan/trace_set.hpp"
#include "trace/vulkan/traversal.hpp"

namespace vantage::vulkan {

class VulkanRayFinder final : public RayFinder {
 public:
  // REQUIRES: an engine with build_walk, a scene with triangles.
  VulkanRayFinder(const VulkanEngine& engine, const EngineInfo& info, std::shared_ptr<Instance> instance,
                  VkPhysicalDevice physical, const DeviceAbilities& abilities, const SceneData& scene);

  const EngineInfo& info() const override { return info_; }
  std::size_t most_rays() const override;
  void reserve(std::size_t rays) override;
  std::span<OwnRay> rays(std::size_t slot) override { return {slots_[slot].rays.mapped<OwnRay>(), room_}; }
  void find(std::size_t slot, std::size_t count, RayQuestion question, std::uint32_t end) override;
  std::span<const std::uint32_t> answers(std::size_t slot) const override {
    return {slots_[slot].answers.mapped<std::uint32_t>(), room_};
  }
  double device_seconds() const override { return device_seconds_; }

 private:
  const ComputePipeline& pipeline(RayQuestion question);

  struct Slot {
    Buffer rays, answers;
  };

  EngineInfo info_;
  bool shares_;
  Device device_;
  Commands commands_;
  std::unique_ptr<RayWalk> walk_;
  Buffer parameters_;
  TraceSet set_;
  std::map<RayQuestion, ComputePipeline> pipelines_;  // compiled when first asked for
  std::size_t room_ = 0;
  std::array<Slot, kSlots> slots_;
  Buffer rays_, answers_;  // of the slot at work
  double device_seconds_ = 0;
};

}  // namespace vantage::vulkan
