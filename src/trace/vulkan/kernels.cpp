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

ComputePipeline Kernels::compiled(const KernelVariant& variant) const {
  const Source source = source_of(variant.kernel, traversal_);
  std::vector<ComputePipeline::Constant> values;
  for (std::uint32_t k = 0; k < source.constants; ++k) values.push_back({k, variant.constants[k]});
  values.push_back({turned_constant, variant.turned});  // these have no effect on kernels without them
  values.push_back({listed_constant, variant.listed});
  values.push_back({glass_constant, glass_});
  values.push_back({shared_constant, shared_});
  return {device_, source.shader, source.push_bytes, values, set_, source.name};
}

void Kernels::compile(std::span<const KernelVariant> wanted) {
  for (const KernelVariant& variant : wanted)
    if (auto& pipeline = pipelines_[variant]; !pipeline.valid())
      pipeline = std::async(when_, [this, variant] { return compiled(variant); }).share();
}

BoundPipeline Kernels::get(const TraceSet& set, const KernelVariant& variant) {
  compile({&variant, 1});
  return {&pipelines_.at(variant).get(), set.handle()};
}

}  // namespace vantage::vulkan
