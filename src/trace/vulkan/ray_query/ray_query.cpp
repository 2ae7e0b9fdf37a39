// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/ray_query/ray_query.hpp"

#include "embedded_shaders.hpp"
#include "shared/ray_query_types.h"
#include "trace/vulkan/ray_query/acceleration_structure.hpp"

namespace vantage::vulkan {
namespace {

TraversalBinding binding_of(const AccelerationStructure& structure) {
  TraversalBinding binding;
  binding.arrays[primitive_ids_array] = structure.primitives();
  binding.arrays[query_instances_array] = structure.instances();
  binding.structure = structure.handle();
  return binding;
}

class RayQuery final : public Traversal {
 public:
  RayQuery(Device& device, Commands& commands, const TraversalScene& scene) : structure_(device, commands, scene) {}

  TraceShaders shaders() const override {
    return {shaders::count_ray_query, shaders::scan_ray_query, shaders::sample_probe_ray_query,
            shaders::sample_trace_ray_query};
  }
  TraversalBinding binding() const override { return binding_of(structure_); }

 private:
  AccelerationStructure structure_;
};

class BoxQuery final : public RayWalk {
 public:
  BoxQuery(Device& device, Commands& commands, const TraversalScene& scene)
      : structure_(device, commands, scene, AccelerationStructure::Over::boxes) {}

  Shader own_rays() const override { return shaders::own_rays_ray_query; }
  TraversalBinding binding() const override { return binding_of(structure_); }

 private:
  AccelerationStructure structure_;
};

}  // namespace

const VulkanEngine ray_query_engine{
    Engine::ray_query, DeviceNeeds::ray_query,
    [](Device& device, Commands& commands, const TraversalScene& scene) -> std::unique_ptr<Traversal> {
      return std::make_unique<RayQuery>(device, commands, scene);
    },
    true,
    [](Device& device, Commands& commands, const TraversalScene& scene) -> std::unique_ptr<RayWalk> {
      return std::make_unique<BoxQuery>(device, commands, scene);
    }};

}  // namespace vantage::vulkan
