// SPDX-License-Identifier: Apache-2.0
// The compute pipelines of one engine on one device, each compiled when first used: a run pays only for what it asks
// for.
#pragma once

#include <array>
#include <map>
#include <optional>

#include "trace/vulkan/device.hpp"
#include "trace/vulkan/pipeline.hpp"

namespace vantage::vulkan {

enum class Kernel {
  count,
  scan,
  tiles,
  tile_list,
  tile_starts,
  clamp,
  reduce,
  sample_list,
  sample_queue,
  sample_arguments,
  sample_trace
};

class Kernels {
 public:
  Kernels(const Device& device, Engine engine, const TraceSet& set) : device_(device), engine_(engine), set_(set) {}

  // `constants` are the kernel's specialization constants, in the order of their constant_id.
  const ComputePipeline& get(Kernel kernel, std::array<bool, 3> constants = {});

 private:
  const Device& device_;
  Engine engine_;
  const TraceSet& set_;
  std::map<std::pair<Kernel, std::array<bool, 3>>, ComputePipeline> pipelines_;
};

}  // namespace vantage::vulkan
