// SPDX-License-Identifier: Apache-2.0
// Compute pipelines of one engine on one device. Each is compiled before its first use, so a run pays only for what it
// uses. The driver of a graphics card takes some tenths of a second for each that it has not seen before, so a job
// names all of its kernels first, and these are compiled side by side. A software device compiles one after the other,
// each when it is wanted: its compiler takes tens of megabytes a thread.
#pragma once

#include <array>
#include <compare>
#include <future>
#include <map>
#include <span>

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

// A kernel with its specialization constants, in the order of their constant_id, for upright or for turned stations,
// and for patterns that are grids or lists.
struct KernelVariant {
  Kernel kernel;
  std::array<bool, 4> constants = {};
  bool turned = false, listed = false;
  auto operator<=>(const KernelVariant&) const = default;
};

class Kernels {
 public:
  // `set`: for kernels that work with any scanner's set. `glass`: whether glass weakens echoes. `shared`: whether
  // meshes are shared. All other arguments must outlive it.
  Kernels(const Device& device, bool software, const Traversal& traversal, const TraceSet& set, bool glass, bool shared)
      : device_(device),
        when_(software ? std::launch::deferred : std::launch::async),
        traversal_(traversal),
        set_(set),
        glass_(glass),
        shared_(shared) {}

  // Begins to compile those of `wanted` that are not known yet, and does not wait for them. REQUIRES, as get() does:
  // for tile_pass, an engine that has one.
  void compile(std::span<const KernelVariant> wanted);
  BoundPipeline get(Kernel kernel) { return get(set_, {kernel}); }
  // For the scanner that owns the set. Waits until it is compiled. Throws what compiling it threw.
  BoundPipeline get(const TraceSet& set, const KernelVariant& variant);

 private:
  ComputePipeline compiled(const KernelVariant& variant) const;

  const Device& device_;
  std::launch when_;
  const Traversal& traversal_;
  const TraceSet& set_;
  bool glass_, shared_;
  std::map<KernelVariant, std::shared_future<ComputePipeline>> pipelines_;
};

}  // namespace vantage::vulkan
