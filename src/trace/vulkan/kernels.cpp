// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/kernels.hpp"

#include <cassert>

#include "embedded_shaders.hpp"
#include "shared/trace_types.h"

namespace vantage::vulkan {
namespace {

struct Shader {
  const char* name;
  const std::uint32_t* words;
  std::size_t bytes;
  std::uint32_t push_bytes;
  std::uint32_t constants;  // how many specialization constants it has
  bool traces;              // binds the acceleration structure
};

Shader shader_of(Kernel kernel, Engine engine) {
  const bool query = engine == Engine::ray_query;
  switch (kernel) {
    case Kernel::count:
      return {"count", query ? shaders::count_ray_query : shaders::count_compute_bvh,
              query ? shaders::count_ray_query_size : shaders::count_compute_bvh_size, sizeof(CountPush), 3, true};
    case Kernel::scan:
      return {"scan", query ? shaders::scan_ray_query : shaders::scan_compute_bvh,
              query ? shaders::scan_ray_query_size : shaders::scan_compute_bvh_size, sizeof(ScanPush), 1, true};
    case Kernel::sample_trace:
      return {"sample trace", query ? shaders::sample_trace_ray_query : shaders::sample_trace_compute_bvh,
              query ? shaders::sample_trace_ray_query_size : shaders::sample_trace_compute_bvh_size, sizeof(SamplePush), 2, true};
    case Kernel::tiles: return {"tiles", shaders::tiles, shaders::tiles_size, sizeof(TilePush), 0, false};
    case Kernel::tile_list: return {"tile list", shaders::tile_list, shaders::tile_list_size, sizeof(TilePush), 0, false};
    case Kernel::clamp: return {"clamp", shaders::clamp, shaders::clamp_size, sizeof(ClampPush), 0, false};
    case Kernel::reduce: return {"reduce", shaders::reduce, shaders::reduce_size, sizeof(ReducePush), 0, false};
    case Kernel::sample_list: return {"sample list", shaders::sample_list, shaders::sample_list_size, sizeof(SamplePush), 0, false};
    case Kernel::sample_queue: return {"sample queue", shaders::sample_queue, shaders::sample_queue_size, sizeof(SamplePush), 0, false};
    case Kernel::sample_arguments:
      return {"sample arguments", shaders::sample_arguments, shaders::sample_arguments_size, sizeof(SamplePush), 1, false};
  }
  assert(false);
  return {};
}

}  // namespace

const ComputePipeline& Kernels::get(Kernel kernel, std::array<bool, 3> constants) {
  ComputePipeline& pipeline = pipelines_[{kernel, constants}];
  if (!pipeline) {
    const Shader shader = shader_of(kernel, engine_);
    const std::array<std::uint32_t, 3> words{constants[0], constants[1], constants[2]};
    pipeline = ComputePipeline(device_, shader.words, shader.bytes, shader.push_bytes,
                               std::span<const std::uint32_t>(words).first(shader.constants),
                               shader.traces ? set_layout_ : VkDescriptorSetLayout{}, shader.name);
  }
  return pipeline;
}

}  // namespace vantage::vulkan
