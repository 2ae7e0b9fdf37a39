// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/kernels.hpp"

#include <cassert>
#include <vector>

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
};

Shader shader_of(Kernel kernel, Engine engine) {
  const bool query = engine == Engine::ray_query;
  switch (kernel) {
    case Kernel::count:
      return {"count", query ? shaders::count_ray_query : shaders::count_compute_bvh,
              query ? shaders::count_ray_query_size : shaders::count_compute_bvh_size, sizeof(CountPush), 3};
    case Kernel::scan:
      return {"scan", query ? shaders::scan_ray_query : shaders::scan_compute_bvh,
              query ? shaders::scan_ray_query_size : shaders::scan_compute_bvh_size, sizeof(ScanPush), 1};
    case Kernel::sample_trace:
      return {"sample trace", query ? shaders::sample_trace_ray_query : shaders::sample_trace_compute_bvh,
              query ? shaders::sample_trace_ray_query_size : shaders::sample_trace_compute_bvh_size, sizeof(SamplePush),
              2};
    case Kernel::tiles: return {"tiles", shaders::tiles, shaders::tiles_size, sizeof(TilePush), 0};
    case Kernel::tile_list: return {"tile list", shaders::tile_list, shaders::tile_list_size, sizeof(TilePush), 0};
    case Kernel::tile_starts:
      return {"tile starts", shaders::tile_starts, shaders::tile_starts_size, sizeof(TilePush), 0};
    case Kernel::clamp: return {"clamp", shaders::clamp, shaders::clamp_size, sizeof(ClampPush), 0};
    case Kernel::reduce: return {"reduce", shaders::reduce, shaders::reduce_size, sizeof(ReducePush), 0};
    case Kernel::sample_list:
      return {"sample list", shaders::sample_list, shaders::sample_list_size, sizeof(SamplePush), 0};
    case Kernel::sample_queue:
      return {"sample queue", shaders::sample_queue, shaders::sample_queue_size, sizeof(SamplePush), 0};
    case Kernel::sample_arguments:
      return {"sample arguments", shaders::sample_arguments, shaders::sample_arguments_size, sizeof(SamplePush), 1};
  }
  assert(false);
  return {};
}

}  // namespace

const ComputePipeline& Kernels::get(Kernel kernel, std::array<bool, 3> constants) {
  ComputePipeline& pipeline = pipelines_[{kernel, constants}];
  if (!pipeline) {
    const Shader shader = shader_of(kernel, engine_);
    std::vector<ComputePipeline::Constant> values;
    for (std::uint32_t k = 0; k < shader.constants; ++k) values.push_back({k, constants[k]});
    pipeline = ComputePipeline(device_, shader.words, shader.bytes, shader.push_bytes, values, set_, shader.name);
  }
  return pipeline;
}

}  // namespace vantage::vulkan
