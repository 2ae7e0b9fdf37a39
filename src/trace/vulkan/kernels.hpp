// SPDX-License-Identifier: Apache-2.0
// Compute pipelines of one engine on one device. Each is compiled on first use, so a run pays only for what it uses.
#pragma once

#include <array>
#include <map>
#include <tuple>

#include "trace/vulkan/device.hpp"
#include "trace/vulkan/pipeline.hpp"
#include "trace/vulkan/traversal.hpp"

namespace vantage::vulkan {

enum class Kernel {
  count,
  scan,
  tiles,
  tile_list,
  tile_pass,
  clamp,
  reduce,
  sample_probe,
  sample_list,
  sample_sights,
  sample_queue,
  sample_arguments,
  sample_trace,
  registration
};

class Kernels {
 public:
  // `set`: for kernels that work with any scanner's set. `glass`: whether glass weakens echoes. `shared`: whether
  // meshes are shared. All other arguments must outlive it.
  Kernels(const Device& device, const Traversal& traversal, const TraceSet& set, bool glass, bool shared)
      : device_(device), traversal_(traversal), set_(set), glass_(glass), shared_(shared) {}

  // `constants`: the kernel's specialization constants, in the order of their constant_id. REQUIRES: for tile_pass, an
  // engine that has one.
  BoundPipeline get(Kernel kernel, std::array<bool, 4> constants = {}) { return get(set_, false, kernel, constants); }
  // For the scanner that owns the set. `turned`: for turned stations.
  BoundPipeline get(const TraceSet& set, bool turned, Kernel kernel, std::array<bool, 4> constants = {});

 private:
  const Device& device_;
  const Traversal& traversal_;
  const TraceSet& set_;
  bool glass_, shared_;
  std::map<std::tuple<Kernel, std::array<bool, 4>, bool>, ComputePipeline> pipelines_;
};

}  // namespace vantage::vulkan
