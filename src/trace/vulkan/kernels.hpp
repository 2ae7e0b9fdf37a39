// SPDX-License-Identifier: Apache-2.0
// Compute pipelines of one engine on one device. Each is compiled before its first use, so that a run pays only for
// what it uses. A graphics card's driver takes some tenths of a second for each pipeline that it has not seen before. A
// job therefore names all of its kernels first, and these are compiled in parallel. A software device compiles them one
// by one, on first use: its compiler takes tens of megabytes for each thread.
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
  // `set`: for kernels that work with any scanner's set. `glass`: true if glass weakens echoes. `shared`: true if
  // meshes are shared. All other arguments must outlive it.
  Kernels(const Device& device, bool software, const Traversal& traversal, const TraceSet& set, bool glass, bool shared)
      : device_(device),
        when_(software ? std::launch::deferred : std::launch::async),
        traversal_(traversal),
        set_(set),
        glass_(glass),
        shared_(shared) {}

  // Starts to compile those of `wanted` that are not known yet, without waiting. REQUIRES, as get() does: an engine
  // with a tile pass for tile_pass.
  void compile(std::span<const KernelVariant> wanted);
  BoundPipeline get(Kernel kernel) { return get(set_, {kernel}); }
  // Returns a kernel for the scanner that owns the set. Waits for its compilation, and throws its errors.
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
