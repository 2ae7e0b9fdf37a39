// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/kernels.hpp"

#include <cassert>
#include <vector>

#include "embedded_shaders.hpp"
#include "shared/registration_types.h"
#include "shared/trace_types.h"

namespace vantage::vulkan {
namespace {

struct Source {
  const char* name;
  Shader shader;
  std::uint32_t push_bytes;
  std::uint32_t constants;  // number of specialization constants
};

Source source_of(Kernel kernel, const Traversal& traversal) {
  switch (kernel) {
    case Kernel::count: return {"count", traversal.shaders().count, sizeof(CountPush), 4};
    case Kernel::scan: return {"scan", traversal.shaders().scan, sizeof(ScanPush), 2};
    case Kernel::sample_probe: return {"sample probe", traversal.shaders().sample_probe, sizeof(SampleProbePush), 4};
    case Kernel::sample_trace: return {"sample trace", traversal.shaders().sample_trace, sizeof(SamplePush), 3};
    case Kernel::tile_pass: return {"tile pass", traversal.tile_pass().value().shader, sizeof(TilePush), 0};
    case Kernel::tiles: return {"tiles", shaders::tiles, sizeof(TilePush), 0};
    case Kernel::tile_list: return {"tile list", shaders::tile_list, sizeof(TilePush), 0};
    case Kernel::clamp: return {"clamp", shaders::clamp, sizeof(ClampPush), 0};
    case Kernel::reduce: return {"reduce", shaders::reduce, sizeof(ReducePush), 0};
    case Kernel::registration: return {"registration", shaders::registration, sizeof(RegisterPush), 0};
    case Kernel::sample_list: return {"sample list", shaders::sample_list, sizeof(SamplePush), 0};
    case Kernel::sample_sights: return {"sample sights", shaders::sample_sights, sizeof(SamplePush), 0};
    case Kernel::sample_queue: return {"sample queue", shaders::sample_queue, sizeof(SamplePush), 0};
    case Kernel::sample_arguments:
      return {"sample arguments", shaders::sample_arguments, sizeof(SampleArgumentsPush), 0};
  }
  assert(false);
  return {};
}

}  // namespace

BoundPipeline Kernels::get(const TraceSet& set, bool turned, Kernel kernel, std::array<bool, 4> constants) {
  ComputePipeline& pipeline = pipelines_[{kernel, constants, turned}];
  if (!pipeline) {
    const Source source = source_of(kernel, traversal_);
    std::vector<ComputePipeline::Constant> values;
    for (std::uint32_t k = 0; k < source.constants; ++k) values.push_back({k, constants[k]});
    values.push_back({turned_constant, turned});  // these have no effect on kernels without them
    values.push_back({glass_constant, glass_});
    values.push_back({shared_constant, shared_});
    pipeline = ComputePipeline(device_, source.shader, source.push_bytes, values, set_, source.name);
  }
  return {&pipeline, set.handle()};
}

}  // namespace vantage::vulkan
